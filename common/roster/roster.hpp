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
  std::uint32_t coil_slot = 0;            ///< 0 = none granted
  bool operator==(const RosterEntry&) const = default;
};

}  // namespace limbcast::roster
