#include "common/filters/position/known_attitude_start.hpp"

#include <algorithm>
#include <cmath>

namespace limbcast::filters {

// Notation: E earth (the optical frame), S sensor.

void KnownAttitudeStart::Clear() { *this = KnownAttitudeStart(gravity_m_s2_, p_sensor_marker_m_); }

std::optional<NavigationState> KnownAttitudeStart::Add(const InertialReading& reading, double dt_s,
                                                       const Eigen::Quaterniond& q_earth_sensor,
                                                       const std::optional<TimedMarker>& marker) {
  if (begun_ && dt_s > kLongestStep_s) {
    Clear();
  }
  const Eigen::Vector3d accel_E =
      q_earth_sensor * reading.accel_m_s2 - gravity_m_s2_ * Eigen::Vector3d::UnitZ();
  if (begun_) {
    s_m_ += dt_s * ds_m_s_ + dt_s * dt_s * (accel_E_ / 3.0 + accel_E / 6.0);
    ds_m_s_ += 0.5 * dt_s * (accel_E_ + accel_E);
    t_s_ += dt_s;
  }
  accel_E_ = accel_E;
  if (marker) {
    const Eigen::Vector3d at_m = marker->p_earth_marker_m - q_earth_sensor * p_sensor_marker_m_;
    if (!begun_) {
      begun_ = true;  // the window begins with its first marker
      first_m_ = at_m;
    }
    const Eigen::Vector3d y_m = at_m - first_m_ - s_m_;
    ++n_;
    sum_t_ += t_s_;
    sum_tt_ += t_s_ * t_s_;
    sum_y_ += y_m;
    sum_ty_ += t_s_ * y_m;
    sum_yy_ += y_m.squaredNorm();
  }
  if (t_s_ < kWindow_s) {
    return std::nullopt;
  }
  if (n_ < kFewestMarkers) {
    Clear();
    return std::nullopt;
  }
  const double n = n_;
  const double var_t = sum_tt_ - sum_t_ * sum_t_ / n;
  const Eigen::Vector3d v0 = (sum_ty_ - sum_t_ / n * sum_y_) / std::max(var_t, 1e-9);
  const Eigen::Vector3d p0 = (sum_y_ - sum_t_ * v0) / n;
  const double left_m2 = sum_yy_ - sum_y_.squaredNorm() / n - var_t * v0.squaredNorm();
  NavigationState navigation;
  navigation.q_earth_sensor = q_earth_sensor;
  navigation.p_earth_sensor_m = first_m_ + p0 + t_s_ * v0 + s_m_;
  navigation.v_earth_sensor_m_s = v0 + ds_m_s_;
  const bool good = left_m2 <= 3.0 * n * kMostLeft_m * kMostLeft_m;
  Clear();
  return good ? std::optional(navigation) : std::nullopt;
}

}  // namespace limbcast::filters
