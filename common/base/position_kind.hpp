#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace limbcast {

/// Where a position comes from. Numbers are part of the wire contract.
enum class FillKind : std::uint8_t {
  kNone = 0,              ///< there is no position
  kMeasured = 1,          ///< a marker or a coil pulse was fused at this time
  kInertialSmoothed = 2,  ///< between measurements, from both sides
  kInertialForward = 3,   ///< after the last measurement so far, from one side
  kPolynomial = 4,        ///< neither measurement nor inertial readings: a curve between the ends
};

[[nodiscard]] constexpr std::string_view ToString(FillKind kind) {
  constexpr std::array<std::string_view, 5> kNames = {"none", "measured", "inertial_smoothed",
                                                      "inertial_forward", "polynomial"};
  const auto index = static_cast<std::size_t>(kind);
  return index < kNames.size() ? kNames[index] : "unknown";
}

/// What a position counts from. Numbers are part of the wire contract.
enum class PositionReference : std::uint8_t {
  kEarth = 0,   ///< the origin of the earth frame, as the optical system has it
  kSensor = 1,  ///< the sensor of another segment (the one that carries the coils), earth axes
};

}  // namespace limbcast
