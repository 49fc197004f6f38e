#include "common/filters/field_monitor.hpp"

#include "common/filters/rest_kernel.hpp"

namespace limbcast::filters {
namespace {

constexpr double kDisturbed = 0.15;

}  // namespace

void FieldMonitor::Update(double norm2, double vertical, double reference_vertical, double dt_s) {
  state_.mean_square =
      kernel::MeanSquareDeviation(state_.mean_square, norm2, vertical, reference_vertical, dt_s);
}

MagneticState FieldState(double mean_square) {
  return mean_square > kDisturbed * kDisturbed ? MagneticState::kDisturbed : MagneticState::kClean;
}

}  // namespace limbcast::filters
