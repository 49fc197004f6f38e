#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "common/base/ids.hpp"
#include "common/base/time.hpp"

namespace limbcast::sensing {

/// One pulse of one coil as one magnetometer sensed it.
struct CoilPulse {
  Time on_at{};
  Time off_at{};
  float current_a = 0.0F;  ///< signed coil current during the plateau
  Eigen::Vector3f field_tesla = Eigen::Vector3f::Zero();  ///< sensor axes, earth field removed
  float sigma_tesla = 0.0F;                               ///< 1-sigma of one axis of field_tesla
  bool valid = false;  ///< false: clipped, masked, or an edge was missing
};

/// The three pulses (one for each orthogonal coil) of one burst, seen by one sensor.
struct CoilBurst {
  SensorUid sensor_uid;
  SensorUid source_uid;
  std::uint32_t sequence = 0;
  std::uint32_t slot = 0;  ///< time slot granted to the source by the session host
  Time measured_at{};      ///< middle of the burst
  Time published_at{};
  std::array<CoilPulse, 3> pulses;
};

}  // namespace limbcast::sensing
