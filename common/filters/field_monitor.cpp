#include "common/filters/field_monitor.hpp"

#include <algorithm>
#include <cmath>

namespace limbcast::filters {
namespace {

constexpr double kAverage_s = 0.3;
constexpr double kDisturbed = 0.15;
constexpr double kMostDeviation = 10.0;  // so that one absurd reading is forgotten in two seconds

}  // namespace

void FieldMonitor::Update(double norm, double vertical, double reference_vertical, double dt_s) {
  const double norm_error = norm - 1.0;
  const double vertical_error = vertical - reference_vertical;
  const double deviation = std::min(
      std::sqrt(norm_error * norm_error + vertical_error * vertical_error), kMostDeviation);
  state_.mean_deviation +=
      std::min(dt_s * (1.0 / kAverage_s), 1.0) * (deviation - state_.mean_deviation);
}

MagneticState FieldMonitor::magnetic_state() const {
  return state_.mean_deviation > kDisturbed ? MagneticState::kDisturbed : MagneticState::kClean;
}

}  // namespace limbcast::filters
