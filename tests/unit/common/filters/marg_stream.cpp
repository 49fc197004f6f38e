#include "tests/unit/common/filters/marg_stream.hpp"

#include <cmath>

#include "common/base/time.hpp"
#include "common/math/rotation.hpp"

namespace limbcast::test_support {
namespace {

constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;
constexpr double kLongestStep_s = 0.002;  // of the true motion

}  // namespace

MargStream::MargStream(const MargStreamConfig& config)
    : config_(config),
      rng_(config.seed),
      frequency_rad_s_(Eigen::Matrix3d::Zero()),
      phase_rad_(Eigen::Matrix3d::Zero()),
      q_(config.q_start.normalized()) {
  std::uniform_real_distribution<double> frequency(0.4, 2.2);
  std::uniform_real_distribution<double> phase(0.0, 6.28);
  frequency_rad_s_ = frequency_rad_s_.unaryExpr([&](double) { return 3.0 * frequency(rng_); });
  phase_rad_ = phase_rad_.unaryExpr([&](double) { return phase(rng_); });
}

Eigen::Vector3d MargStream::Noise(double sigma) {
  if (sigma == 0.0) {
    return Eigen::Vector3d::Zero();
  }
  return sigma * Eigen::Vector3d(normal_(rng_), normal_(rng_), normal_(rng_));
}

void MargStream::Advance(double dt_s) {
  const Eigen::Quaterniond before = q_;
  const int steps = static_cast<int>(std::ceil(dt_s / kLongestStep_s));
  const double step_s = dt_s / steps;
  for (int i = 0; i < steps; ++i) {
    const double t = time_s_ + (i + 0.5) * step_s - config_.rest_s;
    if (t > 0.0 && config_.rate_rms_rad_s > 0.0) {
      // Three sines for each axis; their rms is √1.5 of one's amplitude.
      const Eigen::Matrix3d sines =
          (t * frequency_rad_s_ + phase_rad_).unaryExpr([](double x) { return std::sin(x); });
      const Eigen::Vector3d w =
          config_.rate_rms_rad_s / std::sqrt(1.5) / std::sqrt(3.0) * sines.rowwise().sum();
      q_ = (q_ * math::ExpSO3(w * step_s)).normalized();
    }
  }
  time_s_ += dt_s;
  // The mean rate: exactly what turns the one orientation into the other, as long as that is less
  // than half a turn.
  rate_rad_s_ = math::LogSO3(before.conjugate() * q_) / dt_s;
}

void MargStream::Skip(double seconds) { Advance(seconds); }

sensing::MargSample MargStream::Next() {
  Advance(1.0 / config_.rate_hz);
  sensing::MargSample sample;
  sample.sequence = ++sequence_;
  sample.measured_at =
      TimeFromNanoseconds(kStart_ns + static_cast<std::int64_t>(std::llround(time_s_ * 1e9)));
  Eigen::Vector3d accel_E(0.0, 0.0, kGravity_m_s2);
  if (config_.accel_rms_m_s2 > 0.0 && time_s_ > config_.rest_s) {
    accel_E += std::sqrt(2.0 / 3.0) * config_.accel_rms_m_s2 *
               Eigen::Vector3d(std::sin(5.1 * time_s_), std::sin(6.3 * time_s_ + 1.0),
                               std::sin(7.7 * time_s_ + 2.0));
  }
  Eigen::Vector3d mag_E = config_.field_tesla * Eigen::Vector3d(0.0, std::cos(config_.dip_rad),
                                                                -std::sin(config_.dip_rad));
  if (config_.nearby_tesla) {
    mag_E += config_.nearby_tesla(time_s_);
  }
  Eigen::Vector3d mag_S = q_.conjugate() * mag_E;
  if (config_.carried_tesla) {
    mag_S += config_.carried_tesla(time_s_);
  }
  sample.gyro_rad_s = ((Eigen::Matrix3d::Identity() + config_.gyro_matrix_error) * rate_rad_s_ +
                       config_.gyro_bias_rad_s + Noise(config_.gyro_noise_rad_s))
                          .cast<float>();
  sample.accel_m_s2 = (q_.conjugate() * accel_E + Noise(config_.accel_noise_m_s2)).cast<float>();
  sample.mag_tesla = (mag_S + Noise(config_.mag_noise_tesla)).cast<float>();
  return sample;
}

}  // namespace limbcast::test_support
