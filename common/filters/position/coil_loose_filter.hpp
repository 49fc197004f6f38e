#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "common/base/result.hpp"
#include "common/filters/position/coil_inertial_filter.hpp"
#include "common/filters/position/coil_motion_solver.hpp"
#include "common/filters/position/coil_pulse_collector.hpp"

namespace limbcast::filters {

/// CoilInertialFilter in loose coupling, for comparison with it (design/position.md section 10,
/// last line): three pulses give a pose by least squares (section 8), and the pose, not the
/// samples, is the measurement:
///
///   p_M = R_mᵀ p ,  Ψ = R_sᵀ R_m ,  covariance A⁻¹ + J_v P_vv J_vᵀ + floor
///
/// It applies at the middle of its second pulse, which is over by then: a filter stands there (the
/// anchor), takes the pose and comes again over the frames since. All else is CoilInertialFilter:
/// mechanisation, states, samples between pulses, gauges, start and re-acquisition. No pulse is
/// used in two poses.
///
/// Lost are: three poses in a row that do not fit, poses too far from where they are expected, too
/// uncertain a position. Allocates at construction only. Thread-compatible; a copy goes on by
/// itself.
class LooseCoilFilter {
 public:
  /// @param config  needs a half space: there is no start on both sides here. The sensor's
  /// calibration
  ///                is not estimated, whatever it says: the specification's states alone.
  [[nodiscard]] static Result<LooseCoilFilter> Make(const CoilInertialConfig& config);

  /// @returns as CoilInertialFilter does; `gate` and `nis` are of the pose (mean 6) where this
  /// frame
  ///          completed one, and a coil that is silent is not told.
  CoilUpdateReport Update(const sensing::CoilFrame& frame);

  [[nodiscard]] CoilPhase phase() const { return now_.phase(); }
  [[nodiscard]] const CoilInertialState& state() const { return now_.state(); }
  [[nodiscard]] const CoilCovariance& covariance() const { return now_.covariance(); }
  [[nodiscard]] int losses() const { return losses_; }

  /// Displaces the estimate without telling the covariance; for tests of recovery.
  void Disturb(const CoilVector& error);

 private:
  /// Frames kept since the anchor: a cycle of pulses and a half at 286 Hz. With more the anchor
  /// moves on.
  static constexpr std::size_t kFrames = 256;

  LooseCoilFilter(const CoilInertialConfig& config, const CoilInertialFilter& filter);

  void Keep(const sensing::CoilFrame& frame);
  void AdvanceAnchor(Time until);
  void UseBurst(CoilUpdateReport& report);
  [[nodiscard]] CoilMotion SolveAtAnchor(std::array<CoilObservation, 3> burst) const;
  [[nodiscard]] bool IsLost() const;
  void BeginTrack(Time at);

  CoilInertialConfig config_;
  CoilInertialFilter now_;
  CoilInertialFilter anchor_;
  Time anchor_at_{};
  std::vector<sensing::CoilFrame> frames_;  // of which the first frame_count_ lie after the anchor
  std::size_t frame_count_ = 0;
  CoilPulseCollector collector_;
  std::array<double, 3> nis_{};  // of the last poses
  int poses_ = 0;                // of this track
  int refused_in_a_row_ = 0;
  int losses_ = 0;
};

}  // namespace limbcast::filters
