#pragma once

#include "common/base/tracking.hpp"

namespace limbcast::filters {

/// What FieldMonitor remembers; copied as bytes when a filter saves its state.
struct FieldMonitorState {
  double mean_square = 0.0;  // of the deviation, in squares of the reference field
};

/// Disturbed or clean, from FieldMonitorState::mean_square.
[[nodiscard]] MagneticState FieldState(double mean_square);

/// Says whether the field agrees with the reference, without needing heading: norm and vertical
/// part are compared, their squares averaged over 0.3 s; 0.15 of the reference field is disturbed.
/// Thread-compatible.
class FieldMonitor {
 public:
  /// @param norm2               squared length of the field, in units of the reference field.
  /// @param vertical            its upward part by the current estimate, same unit.
  /// @param reference_vertical  upward part of the reference field.
  void Update(double norm2, double vertical, double reference_vertical, double dt_s);
  [[nodiscard]] MagneticState magnetic_state() const { return FieldState(state_.mean_square); }
  void Clear() { state_ = {}; }

  [[nodiscard]] const FieldMonitorState& state() const { return state_; }
  [[nodiscard]] FieldMonitorState& mutable_state() { return state_; }

 private:
  FieldMonitorState state_;
};

}  // namespace limbcast::filters
