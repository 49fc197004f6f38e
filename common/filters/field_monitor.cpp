#include "common/filters/field_monitor.hpp"

#include <algorithm>
#include <cmath>

namespace limbcast::filters {
namespace {

constexpr double kAverage_s = 0.3;
constexpr double kDisturbed = 0.15;
constexpr double kMostDeviation = 10.0;  // so that one absurd reading is forgotten in two seconds

}  // namespace

void FieldMonitor::Update(const Eigen::Vector3d& mag_in_earth, const Eigen::Vector3d& reference,
                          double dt_s) {
  const double norm_error = mag_in_earth.norm() - reference.norm();
  const double vertical_error = mag_in_earth.z() - reference.z();
  const double deviation = std::min(
      std::sqrt(norm_error * norm_error + vertical_error * vertical_error), kMostDeviation);
  state_.mean_deviation += dt_s / (kAverage_s + dt_s) * (deviation - state_.mean_deviation);
}

MagneticState FieldMonitor::magnetic_state() const {
  return state_.mean_deviation > kDisturbed ? MagneticState::kDisturbed : MagneticState::kClean;
}

}  // namespace limbcast::filters
