#pragma once

#include <Eigen/Core>
#include <limits>

#include "common/base/time.hpp"

namespace limbcast::sensing {

/// CoilDrive::coil when each coil carries its own tone (CoilTones).
inline constexpr int kAllCoils = 3;

/// What the source does while a magnetometer is read.
struct CoilDrive {
  int coil = -1;           ///< 0, 1, 2: this coil is on; −1: none; kAllCoils: tones
  double current_a = 0.0;  ///< signed, of the plateau; with tones their amplitude
  /// With tones, what flows in each coil; else of no meaning.
  Eigen::Vector3d tones_a = Eigen::Vector3d::Zero();
  /// The current has settled: neither within the settling time after an edge nor in a slot that a
  /// source nearby was granted. False: the magnetometer's reading means nothing.
  bool settled = true;
  /// What flowed, signed, where the source measures it; not finite: nobody did.
  double measured_a = std::numeric_limits<double>::quiet_NaN();
};

/// One tick of a sensor and of the source that it is tracked from, for filters that use every
/// sample (design/position.md section 10). Each in its own axes.
struct CoilFrame {
  Time measured_at{};
  Eigen::Vector3d gyro_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d mag_tesla = Eigen::Vector3d::Zero();
  bool mag_valid = true;            ///< false: none, or clipped
  bool inertial_saturated = false;  ///< one of the inertial readings, here or at the source, was
  bool emitter_inertial = true;     ///< false: a fixed source; the two below mean nothing
  Eigen::Vector3d emitter_gyro_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d emitter_accel_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d emitter_mag_tesla = Eigen::Vector3d::Zero();
  bool emitter_mag_valid = false;  ///< the source's unit has a magnetometer, and it was not clipped
  CoilDrive drive;

  /// The source's magnetometer measured the field around it; while one of its own coils is on, or
  /// settles, it cannot.
  [[nodiscard]] bool HasEmitterField() const {
    return emitter_inertial && emitter_mag_valid && drive.coil < 0 && drive.settled &&
           emitter_mag_tesla.allFinite();
  }
  /// The magnetometer measured the field of `drive` and of what is around.
  [[nodiscard]] bool HasField() const {
    return drive.settled && mag_valid && mag_tesla.allFinite();
  }
};

}  // namespace limbcast::sensing
