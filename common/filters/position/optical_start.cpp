#include "common/filters/position/optical_start.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/filters/two_vector_start.hpp"
#include "common/math/rotation.hpp"

namespace limbcast::filters {

// Notation: L levelled frame (z up, arbitrary heading), S sensor; q_LS turns S into L.

namespace {

constexpr double kRestBlock_s = 0.5;
constexpr double kRestRateStd_rad_s = std::numbers::pi / 180.0;
constexpr double kRestForceOff_m_s2 = 0.3;
constexpr double kLevelWithoutRestAfter_s = 3.0;
constexpr double kLevelOver_s = 2.0;
constexpr double kWindow_s = 2.5;
constexpr double kMaxLengthError = 0.1;
constexpr double kMax3SigmaC = 0.06;
constexpr double kResidualFloor_m = 1e-3;
constexpr double kCorrelation_s = 0.1;  // residuals are model errors: neighbours say the same
constexpr int kMinMarkers = 20;

}  // namespace

OpticalStart::OpticalStart(double gravity_m_s2) : gravity_m_s2_(gravity_m_s2) {}

void OpticalStart::Level(const Eigen::Vector3d& mean_force_S, const Eigen::Vector3d& mean_rate_S,
                         bool at_rest, Time begun_at) {
  const auto q_US = OrientationFromUpright(mean_force_S);
  if (!q_US) {
    return;
  }
  // Keep the heading that the gyro has carried so far: only the tilt is new.
  const double heading_rad = levelled_ ? math::Heading_rad(q_LS_ * q_US->conjugate()) : 0.0;
  q_LS_ = (math::ExpSO3({0.0, 0.0, heading_rad}) * *q_US).normalized();
  levelled_ = true;
  if (at_rest) {
    gyro_bias_rad_s_ = mean_rate_S;
    had_rest_ = true;
    q_LS_rest_ = q_LS_;
    rest_begun_at_ = begun_at;
  }
}

void OpticalStart::CollectRest(Time at, const GatedInertial& inertial) {
  if (block_n_ == 0) {
    block_begun_at_ = at;
  }
  const InertialReading& r = inertial.reading;
  block_s_ += inertial.dt_s;
  ++block_n_;
  block_gyro_ += r.gyro_rad_s;
  block_gyro2_ += r.gyro_rad_s.cwiseAbs2();
  block_force_ += r.accel_m_s2;
  if (block_s_ < kRestBlock_s) {
    return;
  }
  const double n = block_n_;
  const Eigen::Vector3d mean_rate = block_gyro_ / n;
  const Eigen::Vector3d mean_force = block_force_ / n;
  const Eigen::Vector3d var_rate = block_gyro2_ / n - mean_rate.cwiseAbs2();
  const bool still = block_n_ >= 10 &&
                     var_rate.maxCoeff() < kRestRateStd_rad_s * kRestRateStd_rad_s &&
                     mean_rate.norm() < 5.0 * kRestRateStd_rad_s &&
                     std::abs(mean_force.norm() - gravity_m_s2_) < kRestForceOff_m_s2;
  if (still) {
    // A rest goes on while the force keeps its direction.
    const bool same = rest_n_ > 0 && (rest_force_ / rest_n_ - mean_force).norm() < 0.1;
    if (!same) {
      rest_n_ = 0;
      rest_gyro_.setZero();
      rest_force_.setZero();
      rest_begun_at_ = block_begun_at_;
    }
    rest_n_ += block_n_;
    rest_gyro_ += block_gyro_;
    rest_force_ += block_force_;
    Level(rest_force_ / rest_n_, rest_gyro_ / rest_n_, true, rest_begun_at_);
    rest_ended_at_ = at;
    for (Window& window : windows_) {
      window.open = false;
    }
    to_next_window_s_ = 0.0;
  } else {
    rest_n_ = 0;
    rest_gyro_.setZero();
    rest_force_.setZero();
  }
  block_n_ = 0;
  block_s_ = 0.0;
  block_gyro_.setZero();
  block_gyro2_.setZero();
  block_force_.setZero();
}

void OpticalStart::AddToWindow(Window& w, const Eigen::Vector3d& accel_L, double dt_s,
                               const std::optional<TimedMarker>& marker) {
  w.s += dt_s * w.ds + 0.5 * dt_s * dt_s * accel_L;
  w.ds += dt_s * accel_L;
  w.dt_s += dt_s;
  if (!marker) {
    return;
  }
  if (w.n == 0) {
    w.z_first = marker->p_earth_marker_m;
  }
  ++w.n;
  const double t = w.dt_s;
  const double t2 = 0.5 * t * t;
  const Eigen::Vector3d z = marker->p_earth_marker_m - w.z_first;
  Eigen::Matrix<double, 8, 2> rows;  // columns: the equations of x and y
  rows.col(0) << w.s.x(), -w.s.y(), 1.0, 0.0, t, 0.0, t2, 0.0;
  rows.col(1) << w.s.y(), w.s.x(), 0.0, 1.0, 0.0, t, 0.0, t2;
  w.A += rows * rows.transpose();
  w.b += rows * z.head<2>();
  w.zz += z.head<2>().squaredNorm();
  const Eigen::Vector3d row_z(1.0, t, t2);
  w.A_z += row_z * row_z.transpose();
  w.b_z += row_z * (z.z() - w.s.z());
}

std::optional<OpticalStartResult> OpticalStart::Solve(const Window& w) const {
  if (w.n < kMinMarkers) {
    return std::nullopt;
  }
  const Eigen::LDLT<Eigen::Matrix<double, 8, 8>> factor(w.A);
  const Eigen::LDLT<Eigen::Matrix3d> factor_z(w.A_z);
  if (factor.info() != Eigen::Success || factor_z.info() != Eigen::Success ||
      factor.vectorD().minCoeff() <= 0.0 || factor_z.vectorD().minCoeff() <= 0.0) {
    return std::nullopt;
  }
  const Eigen::Matrix<double, 8, 1> x = factor.solve(w.b);
  const Eigen::Vector3d x_z = factor_z.solve(w.b_z);
  const double equations = 2.0 * w.n;
  const double residual2 = std::max(0.0, w.zz - w.b.dot(x)) / (equations - 8.0);
  const double sigma2 = std::max(residual2, kResidualFloor_m * kResidualFloor_m) *
                        std::max(1.0, kCorrelation_s * w.n / w.dt_s);
  const double var_c = sigma2 * factor.solve(Eigen::Matrix<double, 8, 1>::Unit(0))[0];
  const double length = std::hypot(x[0], x[1]);
  if (!x.allFinite() || !x_z.allFinite() || std::abs(length - 1.0) >= kMaxLengthError ||
      !(9.0 * var_c < kMax3SigmaC * kMax3SigmaC)) {
    return std::nullopt;
  }
  const double t = w.dt_s;
  const double c = x[0] / length;
  const double d = x[1] / length;
  const Eigen::Vector3d s_E(c * w.s.x() - d * w.s.y(), d * w.s.x() + c * w.s.y(), w.s.z());
  const Eigen::Vector3d ds_E(c * w.ds.x() - d * w.ds.y(), d * w.ds.x() + c * w.ds.y(), w.ds.z());
  const Eigen::Vector3d p0(x[2], x[3], x_z[0]);
  const Eigen::Vector3d v0(x[4], x[5], x_z[1]);
  const Eigen::Vector3d a0(x[6], x[7], x_z[2]);
  OpticalStartResult out = Turned(std::atan2(d, c));
  out.navigation.p_earth_sensor_m = w.z_first + s_E + p0 + t * v0 + 0.5 * t * t * a0;
  out.navigation.v_earth_sensor_m_s = ds_E + v0 + t * a0;
  return out;
}

// What the levelled frame gives once its heading is known.
OpticalStartResult OpticalStart::Turned(double heading_rad) const {
  OpticalStartResult out;
  const Eigen::Quaterniond q_EL = math::ExpSO3({0.0, 0.0, heading_rad});
  out.heading_rad = heading_rad;
  out.navigation.q_earth_sensor = (q_EL * q_LS_).normalized();
  out.gyro_bias_rad_s = gyro_bias_rad_s_;
  out.had_rest = had_rest_;
  out.rest_begun_at = rest_begun_at_;
  out.rest_ended_at = rest_ended_at_;
  out.q_earth_sensor_at_rest = (q_EL * q_LS_rest_).normalized();
  return out;
}

std::optional<OpticalStartResult> OpticalStart::Guess(double heading_rad) const {
  if (!levelled_ || !last_marker_) {
    return std::nullopt;
  }
  OpticalStartResult out = Turned(heading_rad);
  out.navigation.p_earth_sensor_m = last_marker_->p_earth_marker_m;
  return out;
}

std::optional<OpticalStartResult> OpticalStart::Add(Time at, const GatedInertial& inertial,
                                                    const std::optional<TimedMarker>& marker) {
  if (marker) {
    last_marker_ = marker;
  }
  if (inertial.first || inertial.long_dropout) {
    const std::optional<TimedMarker> kept = last_marker_;
    *this = OpticalStart(gravity_m_s2_);
    last_marker_ = kept;
    last_ = inertial.reading;
    return std::nullopt;
  }
  const double dt_s = inertial.dt_s;
  since_start_s_ += dt_s;
  const Eigen::Vector3d w_S =
      0.5 * (last_.gyro_rad_s + inertial.reading.gyro_rad_s) - gyro_bias_rad_s_;
  const Eigen::Vector3d f0_L = q_LS_ * last_.accel_m_s2;
  q_LS_ = (q_LS_ * math::ExpSO3(w_S * dt_s)).normalized();
  const Eigen::Vector3d f1_L = q_LS_ * inertial.reading.accel_m_s2;
  last_ = inertial.reading;
  CollectRest(at, inertial);

  if (!levelled_) {
    // Not levelled: q_LS is relative to the first sample, and the force averages to gravity.
    unrest_force_L_ += dt_s * f1_L;
    unrest_s_ += dt_s;
    if (since_start_s_ > kLevelWithoutRestAfter_s && unrest_s_ > kLevelOver_s) {
      Level(q_LS_.conjugate() * unrest_force_L_, Eigen::Vector3d::Zero(), false, at);
    }
    return std::nullopt;
  }
  if (rest_n_ > 0) {
    return std::nullopt;  // at rest up to the last block
  }
  searched_s_ += dt_s;
  const Eigen::Vector3d accel_L = 0.5 * (f0_L + f1_L) - Eigen::Vector3d(0.0, 0.0, gravity_m_s2_);
  to_next_window_s_ -= dt_s;
  if (to_next_window_s_ <= 0.0) {
    windows_[next_window_] = Window{};
    windows_[next_window_].open = true;
    windows_[next_window_].begun_at = at;
    next_window_ = (next_window_ + 1) % windows_.size();
    to_next_window_s_ = 0.5 * kWindow_s;
  }
  for (Window& window : windows_) {
    if (!window.open) {
      continue;
    }
    AddToWindow(window, accel_L, dt_s, marker);
    if (window.dt_s >= kWindow_s) {
      window.open = false;
      if (auto start = Solve(window)) {
        return start;
      }
    }
  }
  return std::nullopt;
}

}  // namespace limbcast::filters
