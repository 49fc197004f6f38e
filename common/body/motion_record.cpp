#include "common/body/motion_record.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/math/angles.hpp"
#include "common/math/rotation.hpp"

namespace limbcast::body {
namespace {

std::vector<double> HannWindow(std::size_t half) {
  std::vector<double> weights(2 * half + 1);
  double sum = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double phase = static_cast<double>(i + 1) / static_cast<double>(weights.size() + 1);
    weights[i] = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * phase);
    sum += weights[i];
  }
  for (double& weight : weights) {
    weight /= sum;
  }
  return weights;
}

std::vector<Eigen::Vector3d> Filtered(const std::vector<Eigen::Vector3d>& values,
                                      const std::vector<double>& weights) {
  const auto half = static_cast<std::ptrdiff_t>(weights.size() / 2);
  const auto last = static_cast<std::ptrdiff_t>(values.size()) - 1;
  std::vector<Eigen::Vector3d> out(values.size(), Eigen::Vector3d::Zero());
  for (std::ptrdiff_t i = 0; i <= last; ++i) {
    for (std::ptrdiff_t k = -half; k <= half; ++k) {
      const std::ptrdiff_t from = std::clamp<std::ptrdiff_t>(i + k, 0, last);
      out[static_cast<std::size_t>(i)] +=
          weights[static_cast<std::size_t>(k + half)] * values[static_cast<std::size_t>(from)];
    }
  }
  return out;
}

std::vector<Eigen::Vector3d> Derivative(const std::vector<Eigen::Vector3d>& values,
                                        double rate_hz) {
  std::vector<Eigen::Vector3d> out(values.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 1; i + 1 < values.size(); ++i) {
    out[i] = 0.5 * rate_hz * (values[i + 1] - values[i - 1]);
  }
  return out;
}

/// ω = Log(q(t+h) ⊗ q(t−h)*)/2h, in the earth frame.
std::vector<Eigen::Vector3d> AngularRate(const std::vector<Eigen::Quaterniond>& q, double rate_hz) {
  std::vector<Eigen::Vector3d> out(q.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 1; i + 1 < q.size(); ++i) {
    out[i] = 0.5 * rate_hz * math::LogSO3(q[i + 1] * q[i - 1].conjugate());
  }
  return out;
}

}  // namespace

std::vector<SmoothMotion> Smooth(const MotionRecord& record, double width_s) {
  const auto half = static_cast<std::size_t>(std::max(1.0, width_s * record.rate_hz / 2.0));
  const std::vector<double> weights = HannWindow(half);
  std::vector<SmoothMotion> motions;
  for (const SegmentRecord& raw : record.segments) {
    SmoothMotion motion;
    motion.segment = raw.segment;
    motion.q_earth_sensor = raw.q_earth_sensor;
    motion.accel_in_earth_m_s2 = Filtered(raw.accel_in_earth_m_s2, weights);
    motion.w_earth_sensor_in_earth_rad_s =
        Filtered(AngularRate(raw.q_earth_sensor, record.rate_hz), weights);
    motion.alpha_in_earth_rad_s2 = Derivative(motion.w_earth_sensor_in_earth_rad_s, record.rate_hz);
    motions.push_back(std::move(motion));
  }
  return motions;
}

void Cut(std::size_t begin, std::size_t end, std::vector<SmoothMotion>& motions) {
  const auto cut = [&](auto& values) {
    values.erase(values.begin() + static_cast<std::ptrdiff_t>(end), values.end());
    values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(begin));
  };
  for (SmoothMotion& motion : motions) {
    cut(motion.q_earth_sensor);
    cut(motion.accel_in_earth_m_s2);
    cut(motion.w_earth_sensor_in_earth_rad_s);
    cut(motion.alpha_in_earth_rad_s2);
  }
}

void TurnBack(const std::vector<double>& heading_rad, std::vector<SmoothMotion>& motions) {
  for (std::size_t i = 0; i < heading_rad.size(); ++i) {
    const Eigen::Quaterniond back = math::ExpSO3({0.0, 0.0, -heading_rad[i]});
    for (SmoothMotion& motion : motions) {
      motion.q_earth_sensor[i] = back * motion.q_earth_sensor[i];
      motion.accel_in_earth_m_s2[i] = back * motion.accel_in_earth_m_s2[i];
      motion.w_earth_sensor_in_earth_rad_s[i] = back * motion.w_earth_sensor_in_earth_rad_s[i];
      motion.alpha_in_earth_rad_s2[i] = back * motion.alpha_in_earth_rad_s2[i];
    }
  }
}

std::vector<double> HeadingSince_rad(const Eigen::Quaterniond& reference,
                                     const std::vector<Eigen::Quaterniond>& q_earth_sensor) {
  std::vector<double> heading_rad;
  heading_rad.reserve(q_earth_sensor.size());
  for (const Eigen::Quaterniond& q : q_earth_sensor) {
    const double now_rad = math::Heading_rad(q * reference.conjugate());
    const double last_rad = heading_rad.empty() ? now_rad : heading_rad.back();
    heading_rad.push_back(last_rad + math::WrappedAngle_rad(now_rad - last_rad));
  }
  return heading_rad;
}

std::vector<double> MovingMean(const std::vector<double>& values, std::size_t width) {
  const std::size_t half = width / 2;
  std::vector<double> sums(values.size() + 1, 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    sums[i + 1] = sums[i] + values[i];
  }
  std::vector<double> out(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t from = i > half ? i - half : 0;
    const std::size_t to = std::min(values.size(), i + half + 1);
    out[i] = (sums[to] - sums[from]) / static_cast<double>(to - from);
  }
  return out;
}

}  // namespace limbcast::body
