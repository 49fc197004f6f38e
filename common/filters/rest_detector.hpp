#pragma once

#include <Eigen/Core>

#include "common/filters/rest_kernel.hpp"

namespace limbcast::filters {

/// What RestDetector remembers; copied as bytes when a filter saves its state.
using RestDetectorState = kernel::Rest<double>;

/// At rest is who stays still for 1.5 s: gyro within 2 °/s and accelerometer within 0.5 m/s² of
/// their low-pass (0.5 s), and that low-pass within 2 °/s of the known bias, because a steady
/// rotation is still, too (design/orientation.md section 5). Thread-compatible.
class RestDetector {
 public:
  static constexpr double kRestAfter_s = kernel::kRestAfter_s;

  void Update(const Eigen::Vector3d& gyro_rad_s, const Eigen::Vector3d& accel_m_s2,
              const Eigen::Vector3d& gyro_bias_rad_s, double dt_s);
  /// Nobody can say: a channel is missing.
  void Interrupt() { state_.still_s = 0.0; }

  [[nodiscard]] bool at_rest() const { return state_.still_s > kRestAfter_s; }
  /// How long it has been still.
  [[nodiscard]] double still_s() const { return state_.still_s; }
  /// Low-passed gyro: the bias, while at rest.
  [[nodiscard]] Eigen::Vector3d low_gyro_rad_s() const {
    const auto& low = state_.low_gyro_rad_s;
    return {low.x, low.y, low.z};
  }

  [[nodiscard]] const RestDetectorState& state() const { return state_; }
  [[nodiscard]] RestDetectorState& mutable_state() { return state_; }

 private:
  RestDetectorState state_{};
};

}  // namespace limbcast::filters
