#include "common/filters/field_monitor.hpp"

#include <algorithm>

namespace limbcast::filters {
namespace {

constexpr double kAverage_s = 0.3;
constexpr double kDisturbed = 0.15;
constexpr double kMostSquare = 4.0;  // so that one absurd reading is forgotten in two seconds

}  // namespace

void FieldMonitor::Update(double norm2, double vertical, double reference_vertical, double dt_s) {
  const double norm_error = 0.5 * (norm2 - 1.0);  // |m| − 1 to first order, without a root
  const double vertical_error = vertical - reference_vertical;
  const double square =
      std::min(norm_error * norm_error + vertical_error * vertical_error, kMostSquare);
  state_.mean_square += std::min(dt_s * (1.0 / kAverage_s), 1.0) * (square - state_.mean_square);
}

MagneticState FieldMonitor::magnetic_state() const {
  return state_.mean_square > kDisturbed * kDisturbed ? MagneticState::kDisturbed
                                                      : MagneticState::kClean;
}

}  // namespace limbcast::filters
