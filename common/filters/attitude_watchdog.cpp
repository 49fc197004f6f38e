#include "common/filters/attitude_watchdog.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/filters/filter_constants.hpp"

namespace limbcast::filters {
namespace {

constexpr double kFreeMean_s = 3.0;
constexpr double kTilted_m_s2 = 0.35 * kGravity_m_s2;
constexpr double kTiltedFor_s = 4.0;

constexpr double kNorthMean_s = 4.0;
constexpr double kClean_ref = 0.1;
constexpr double kCleanFor_s = 12.0;
constexpr double kMostClean_s = 20.0;
constexpr double kTurned_rad = 15.0 * std::numbers::pi / 180.0;
constexpr double kLongestLook_s = 1.0;  // a slow stream still needs several looks

}  // namespace

bool AttitudeWatchdog::TiltLost(double T) {
  if (state_.free_count == 0) {
    return false;
  }
  const Eigen::Vector3d mean_m_s2 = state_.free_sum_m_s2 / static_cast<double>(state_.free_count);
  state_.free_sum_m_s2.setZero();
  state_.free_count = 0;
  state_.low_free_m_s2 += std::min(T / kFreeMean_s, 1.0) * (mean_m_s2 - state_.low_free_m_s2);
  state_.tilted_s = state_.low_free_m_s2.norm() > kTilted_m_s2 ? state_.tilted_s + T : 0.0;
  return state_.tilted_s > kTiltedFor_s;
}

bool AttitudeWatchdog::HeadingLost(const Eigen::Vector3d& field_E_ref,
                                   const Eigen::Vector3d& reference_ref, double T) {
  const double deviation =
      std::hypot(field_E_ref.norm() - 1.0, field_E_ref.z() - reference_ref.z());
  const double horizontal = field_E_ref.head<2>().norm();
  if (deviation > kClean_ref || horizontal < kClean_ref) {
    state_.clean_s = std::max(0.0, state_.clean_s - T);
    return false;
  }
  state_.clean_s = std::min(state_.clean_s + T, kMostClean_s);
  state_.low_north +=
      std::min(T / kNorthMean_s, 1.0) * (field_E_ref.head<2>() / horizontal - state_.low_north);
  const double turned_rad = std::abs(std::atan2(state_.low_north.x(), state_.low_north.y()));
  return state_.clean_s > kCleanFor_s && turned_rad > kTurned_rad;
}

AttitudeLoss AttitudeWatchdog::Look(const GatedSample& sample,
                                    const Eigen::Quaterniond& q_earth_sensor,
                                    const Eigen::Vector3d& reference_ref, double per_tesla) {
  const double T = std::min(state_.pending_s, kLongestLook_s);
  state_.pending_s = 0.0;
  if (TiltLost(T)) {
    return AttitudeLoss::kTilt;
  }
  if (sample.mag_valid && reference_ref.y() > kClean_ref &&
      HeadingLost(q_earth_sensor * (sample.mag_tesla * per_tesla), reference_ref, T)) {
    return AttitudeLoss::kHeading;
  }
  return AttitudeLoss::kNone;
}

}  // namespace limbcast::filters
