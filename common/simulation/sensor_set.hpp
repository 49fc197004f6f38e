#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/body/segment.hpp"
#include "common/simulation/marg_model.hpp"
#include "common/simulation/person_shape.hpp"

namespace limbcast::simulation {

enum class SensorSet : std::uint8_t {
  kReduced15,   ///< body::ReducedSegments()
  kStandard17,  ///< and both shoulders
  kAll23,       ///< one on every segment
};

/// The segments that carry a sensor, in the order of body::Segment.
[[nodiscard]] std::span<const body::Segment> SegmentsOf(SensorSet set);

enum class MountingStyle : std::uint8_t {
  kAligned,    ///< sensor axes are segment axes
  kRough,      ///< within 15° about a random axis, as people strap them on
  kArbitrary,  ///< any rotation
};

/// A sensor in the middle of the segment, on the skin: outside of arms and legs, on the back of the
/// trunk, on the instep. The rotation is drawn from `seed`, for each segment by itself.
[[nodiscard]] SensorMounting MakeMounting(body::Segment segment, const PersonShape& shape,
                                          MountingStyle style, std::uint64_t seed);

}  // namespace limbcast::simulation
