#include "tests/unit/common/filters/position/optical_scene.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/math/rotation.hpp"

namespace limbcast::test_support {
namespace {

using Eigen::Vector3d;

constexpr double kFine_hz = 2000.0;
constexpr double kGravity_m_s2 = 9.81;
constexpr double kFadeIn_s = 1.0;

// Weight of the motion: 0 at rest, 1 after the fade-in, with two continuous derivatives.
struct Fade {
  double w = 0.0, dw = 0.0, ddw = 0.0;
};
Fade FadeAt(double t) {
  if (t <= 0.0) {
    return {};
  }
  if (t >= kFadeIn_s) {
    return {1.0, 0.0, 0.0};
  }
  const double u = t / kFadeIn_s;
  return {u * u * u * (10.0 - 15.0 * u + 6.0 * u * u),
          30.0 * u * u * (1.0 - 2.0 * u + u * u) / kFadeIn_s,
          60.0 * u * (1.0 - 3.0 * u + 2.0 * u * u) / (kFadeIn_s * kFadeIn_s)};
}

const Vector3d kFrequency_rad_s = 2.0 * std::numbers::pi * Vector3d(0.9, 1.3, 0.7);
const Vector3d kRateFrequency_rad_s = 2.0 * std::numbers::pi * Vector3d(0.5, 0.8, 1.1);

Vector3d RateAt(const OpticalSceneConfig& c, double t) {
  const Fade fade = FadeAt(t);
  return c.rate_rad_s * fade.w *
         Vector3d(std::sin(kRateFrequency_rad_s.x() * t), std::cos(kRateFrequency_rad_s.y() * t),
                  std::sin(kRateFrequency_rad_s.z() * t + 1.0));
}

struct Point {
  Vector3d p, v, a;
};
Point PointAt(const OpticalSceneConfig& c, double t) {
  const Fade fade = FadeAt(t);
  Point out;
  for (int i = 0; i < 3; ++i) {
    const double f = kFrequency_rad_s[i];
    const double s = std::sin(f * t + i);
    const double k = std::cos(f * t + i);
    out.p[i] = c.amplitude_m * fade.w * s;
    out.v[i] = c.amplitude_m * (fade.dw * s + fade.w * f * k);
    out.a[i] = c.amplitude_m * (fade.ddw * s + 2.0 * fade.dw * f * k - fade.w * f * f * s);
  }
  out.p += Vector3d(0.3, -0.2, 1.1);
  return out;
}

}  // namespace

OpticalScene::OpticalScene(const OpticalSceneConfig& config) : rate_hz_(config.rate_hz) {
  std::mt19937 rng(config.seed);
  std::normal_distribution<double> normal;
  const auto noise = [&](double sigma) {
    return Vector3d(sigma * normal(rng), sigma * normal(rng), sigma * normal(rng));
  };
  const auto rows = static_cast<std::size_t>((config.rest_s + config.motion_s) * config.rate_hz);
  const auto fine_per_row = static_cast<std::size_t>(std::lround(kFine_hz / config.rate_hz));
  constexpr std::size_t kMore = 400;  // for markers that lead
  std::vector<Eigen::Quaterniond> q(rows * fine_per_row + kMore);
  q[0] = math::ExpSO3({0.0, 0.0, config.heading_rad}) * math::ExpSO3({config.tilt_rad, 0.0, 0.0});
  const auto time = [&](std::size_t fine) {
    return static_cast<double>(fine) / kFine_hz - config.rest_s;
  };
  for (std::size_t i = 1; i < q.size(); ++i) {
    const Vector3d w = RateAt(config, time(i) - 0.5 / kFine_hz);
    q[i] = (q[i - 1] * math::ExpSO3(w / kFine_hz)).normalized();
  }
  const Eigen::Matrix3d spoil_accel =
      (Eigen::Matrix3d::Identity() - config.errors.accel_matrix).inverse();
  const Eigen::Matrix3d spoil_gyro =
      (Eigen::Matrix3d::Identity() - config.errors.gyro_matrix).inverse();
  const auto lead = static_cast<std::size_t>(std::lround(config.marker_lead_s * kFine_hz));
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t fine = row * fine_per_row;
    const Point point = PointAt(config, time(fine));
    truth.push_back({point.p, point.v, q[fine]});
    p_earth_marker_m.push_back(point.p + q[fine] * config.p_sensor_marker_m);
    sensing::MargSample sample;
    sample.measured_at = Time{} + DurationFromSeconds(static_cast<double>(row) / config.rate_hz);
    sample.flags = sensing::kMagMissing | sensing::kTemperatureMissing;
    const Vector3d force = q[fine].conjugate() * (point.a + Vector3d(0, 0, kGravity_m_s2));
    sample.accel_m_s2 =
        (spoil_accel * (force + config.errors.accel_bias_m_s2) + noise(config.accel_noise_m_s2))
            .cast<float>();
    sample.gyro_rad_s = (spoil_gyro * (RateAt(config, time(fine)) + config.errors.gyro_bias_rad_s) +
                         noise(config.gyro_noise_rad_s))
                            .cast<float>();
    samples.push_back(sample);
    sensing::MarkerPosition marker;
    marker.measured_at = sample.measured_at;
    marker.visible = true;
    marker.p_earth_marker_m = PointAt(config, time(fine + lead)).p +
                              q[fine + lead] * config.p_sensor_marker_m +
                              noise(config.marker_noise_m);
    markers.push_back(marker);
  }
  first_moving_row = static_cast<std::size_t>(config.rest_s * config.rate_hz);
}

std::size_t OpticalScene::RowOf(Time at) const {
  return static_cast<std::size_t>(std::llround(ToSeconds(at - Time{}) * rate_hz_));
}

void OpticalScene::Hide(std::size_t from, std::size_t to) {
  for (std::size_t row = from; row < std::min(to, rows()); ++row) {
    markers[row].visible = false;
  }
}

filters::OpticalStep FeedRow(filters::OpticalInertialFilter& filter, const OpticalScene& scene,
                             std::size_t row) {
  (void)filter.AddMarker(scene.markers[row]);
  return filter.AddInertial(scene.samples[row]);
}

}  // namespace limbcast::test_support
