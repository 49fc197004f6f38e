#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/base/ids.hpp"
#include "common/base/time.hpp"
#include "common/body/segment.hpp"

namespace limbcast::roster {

/// Which sensor sits on which segment.
struct SensorAssignment {
  SensorUid sensor_uid;
  body::Segment segment = body::Segment::kPelvis;
  bool operator==(const SensorAssignment&) const = default;
};

/// One person of one session (state topic, key body_id). Written by the session host, or by the
/// gateway itself where no host runs.
struct RosterEntry {
  BodyId body_id;
  std::uint32_t revision = 0;             ///< grows with every change
  std::string session;                    ///< at most 64 characters
  std::string person;                     ///< at most 64 characters
  std::vector<SensorAssignment> sensors;  ///< at most 64
  /// When a source of coils that this person wears may pulse: frames of `coil_frame_us` begin at
  /// whole multiples of that on the system clock, each has `coil_slots` slots of equal length, and
  /// `coil_slot` of them, counted from 1, is this person's (0 = none granted).
  std::uint32_t coil_slot = 0;
  std::uint32_t coil_slots = 0;
  std::uint32_t coil_frame_us = 0;
  bool operator==(const RosterEntry&) const = default;
};

}  // namespace limbcast::roster
