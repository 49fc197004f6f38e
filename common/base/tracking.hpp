#pragma once

#include <cstdint>

namespace limbcast {

/// What a filter makes of the magnetic field at this moment. Numbers are part of the wire contract.
enum class MagneticState : std::uint8_t {
  kUnused = 0,     ///< no magnetometer, or it is ignored
  kClean = 1,      ///< the field agrees with the reference
  kDisturbed = 2,  ///< it does not, and counts less or not at all
};

/// What heading means. Numbers are part of the wire contract.
enum class HeadingReference : std::uint8_t {
  kArbitrary = 0,  ///< zero is where the sensor pointed at start; drifts with the gyro
  kMagnetic = 1,   ///< y points to magnetic north
  kTrue = 2,       ///< y points to true north (declination applied)
};

}  // namespace limbcast
