#include "tools/limbcast/evaluate/orientation_metric.hpp"

#include <algorithm>
#include <cmath>

#include "common/units/units.hpp"

namespace limbcast::tool {

// atan2 instead of acos: the same angles, without losing half the digits near zero.
OrientationError ErrorBetween(const Eigen::Quaterniond& q_estimate,
                              const Eigen::Quaterniond& q_reference) {
  const Eigen::Quaterniond e = q_estimate * q_reference.conjugate();
  const double heading_part = std::hypot(e.w(), e.z());
  const double tilt_part = std::hypot(e.x(), e.y());
  return {.total_rad = 2.0 * std::atan2(e.vec().norm(), std::abs(e.w())),
          .heading_rad = 2.0 * std::atan2(std::abs(e.z()), std::abs(e.w())),
          .inclination_rad = 2.0 * std::atan2(tilt_part, heading_part)};
}

void ErrorStatistics::Add(const OrientationError& error) {
  ++count_;
  total_rad2_ += error.total_rad * error.total_rad;
  heading_rad2_ += error.heading_rad * error.heading_rad;
  inclination_rad2_ += error.inclination_rad * error.inclination_rad;
  total_max_rad_ = std::max(total_max_rad_, error.total_rad);
}

double ErrorStatistics::Rms_deg(double sum_rad2) const {
  return count_ == 0 ? 0.0 : units::DegFromRad(std::sqrt(sum_rad2 / static_cast<double>(count_)));
}
double ErrorStatistics::total_rms_deg() const { return Rms_deg(total_rad2_); }
double ErrorStatistics::heading_rms_deg() const { return Rms_deg(heading_rad2_); }
double ErrorStatistics::inclination_rms_deg() const { return Rms_deg(inclination_rad2_); }
double ErrorStatistics::total_max_deg() const { return units::DegFromRad(total_max_rad_); }

}  // namespace limbcast::tool
