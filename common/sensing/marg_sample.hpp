#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "common/base/ids.hpp"
#include "common/base/time.hpp"

namespace limbcast::sensing {

/// Bits of MargSample::flags. Numbers are part of the wire contract: append only.
enum MargFlag : std::uint32_t {
  kGyroMissing = 1U << 0U,    ///< gyro_rad_s means nothing
  kAccelMissing = 1U << 1U,   ///< accel_m_s2 means nothing
  kMagMissing = 1U << 2U,     ///< mag_tesla means nothing: no magnetometer, or no reading
  kGyroSaturated = 1U << 3U,  ///< at least one axis at 99 % of its range
  kAccelSaturated = 1U << 4U,
  kMagSaturated = 1U << 5U,
  kMagHeld = 1U << 6U,  ///< repeats the last reading (magnetometer slower than the gyro)
  kCoilPulseActive =
      1U << 7U,  ///< a coil pulse was on: the magnetometer does not show the earth field
  kTemperatureMissing = 1U << 8U,  ///< temperature_celsius means nothing
  kProbe =
      1U << 9U,  ///< no reading: asks whether the way downstream is open (see services/gateway)
};

/// One reading of one MARG sensor (magnetometer, angular rate, gravity), in the sensor's own
/// right-handed axes, after the gateway applied the calibration in force. Single precision: that is
/// more than any such sensor resolves, and what crosses the wire is then exactly what a filter sees
/// in one process.
struct MargSample {
  SensorUid sensor_uid;
  std::uint32_t sequence =
      0;  ///< counts this sensor's samples at its gateway, from 1; a gap is a loss
  std::uint32_t flags = 0;  ///< MargFlag bits
  Time measured_at{};       ///< when the reading was true, host clock
  Time published_at{};      ///< when the gateway handed it to the bus
  Eigen::Vector3f gyro_rad_s = Eigen::Vector3f::Zero();
  Eigen::Vector3f accel_m_s2 =
      Eigen::Vector3f::Zero();  ///< specific force: +9.81 on the upward axis at rest
  Eigen::Vector3f mag_tesla = Eigen::Vector3f::Zero();
  float temperature_celsius = 0.0F;

  [[nodiscard]] bool Has(MargFlag flag) const { return (flags & flag) != 0; }
};

}  // namespace limbcast::sensing
