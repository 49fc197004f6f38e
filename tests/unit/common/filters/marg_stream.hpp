#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <random>

#include "common/sensing/marg_sample.hpp"

namespace limbcast::test_support {

/// What a synthetic MARG sensor goes through. All values of one sensor; seeded, so that a failure
/// repeats.
struct MargStreamConfig {
  double rate_hz = 100.0;
  unsigned seed = 1;
  double rest_s = 0.0;  ///< at rest for this long at the start
  /// Strength of the rotation about all three axes; 0 = at rest for good.
  double rate_rms_rad_s = 1.5;
  double accel_rms_m_s2 = 0.0;  ///< linear acceleration, bounded position (oscillating)
  Eigen::Quaterniond q_start = Eigen::Quaterniond::Identity();
  Eigen::Vector3d gyro_bias_rad_s = Eigen::Vector3d::Zero();
  Eigen::Matrix3d gyro_matrix_error = Eigen::Matrix3d::Zero();  ///< reading = (I + error)·rate
  double gyro_noise_rad_s = 0.0;
  double accel_noise_m_s2 = 0.0;
  double mag_noise_tesla = 0.0;
  double dip_rad = 1.17;  ///< 67°, middle Europe
  double field_tesla = 48e-6;
  /// Field added in sensor axes (carried magnet) and in earth axes (iron nearby), by time.
  std::function<Eigen::Vector3d(double)> carried_tesla{};
  std::function<Eigen::Vector3d(double)> nearby_tesla{};
};

/// Samples and truth of one synthetic sensor. The reading of the gyro is the mean rate since the
/// previous sample, so that integrating it exactly gives the truth.
class MargStream {
 public:
  static constexpr double kGravity_m_s2 = 9.81;

  explicit MargStream(const MargStreamConfig& config);

  /// The next sample; its truth is q_earth_sensor() afterwards.
  [[nodiscard]] sensing::MargSample Next();

  [[nodiscard]] const Eigen::Quaterniond& q_earth_sensor() const { return q_; }
  [[nodiscard]] double time_s() const { return time_s_; }
  /// Lets this much time pass without a sample.
  void Skip(double seconds);

 private:
  void Advance(double dt_s);
  [[nodiscard]] Eigen::Vector3d Noise(double sigma);

  MargStreamConfig config_;
  std::mt19937 rng_;
  std::normal_distribution<double> normal_;
  Eigen::Matrix3d frequency_rad_s_;
  Eigen::Matrix3d phase_rad_;
  Eigen::Quaterniond q_;
  Eigen::Vector3d rate_rad_s_ = Eigen::Vector3d::Zero();
  double time_s_ = 0.0;
  std::uint32_t sequence_ = 0;
};

}  // namespace limbcast::test_support
