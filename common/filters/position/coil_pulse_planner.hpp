#pragma once

#include <optional>

#include "common/base/result.hpp"
#include "common/filters/position/coil_inertial_filter.hpp"

namespace limbcast::filters {

/// When and with which coil to pulse (design/position.md section 10, adaptive pulsing).
struct CoilPlannerConfig {
  double sigma_p_m = 0.018;         ///< pulse when less certain: √tr P_pp. Range: [1e-4, 1]
  double sigma_theta_rad = 0.05;    ///< the same of the turn between the two. Range: [1e-3, 1]
  double pulse_s = 0.06;            ///< how long one takes. Range: [0.01, 1]
  double gap_s = 0.05;              ///< background seen between two. Range: [0.01, 1]
  int samples = 6;                  ///< settled ones of a pulse. Range: [1, 1000]
  double max_duty = 0.35;           ///< of the time a coil is on. Range: [0.01, 0.9]
  double longest_pause_s = 2.0;     ///< so often one pulse at least. Range: [0.1, 60]
  double current_a = 1.5;           ///< Range: (0, 20]
  double mag_range_tesla = 150e-6;  ///< the current is lowered to stay at 80 % of it. Range: (0, 1]
};
[[nodiscard]] Status Validate(const CoilPlannerConfig& config);

/// Single pulses, as the filter needs them: none while position and orientation are certain enough,
/// else of the coil that takes away most of
///
///   tr P_pp / σ_p² + tr P_rel / σ_θ² ,  P_rel = cov(θ_s − θ_m) ,
///
/// by the update with the mean of `samples` readings of its pulse. Until there is a track the coils
/// take turns. On-time is saved up at `max_duty`, for three pulses at most. Allocates nothing.
/// Thread-compatible.
class CoilPulsePlanner {
 public:
  struct Pulse {
    int coil = 0;
    double current_a = 0.0;
  };

  /// @param filter  source and noise as the filter knows them.
  [[nodiscard]] static Result<CoilPulsePlanner> Make(const CoilPlannerConfig& config,
                                                     const CoilInertialConfig& filter);

  /// To be asked at every tick; the pulse that it names begins now.
  /// @param may_pulse  false: the slot is somebody else's.
  [[nodiscard]] std::optional<Pulse> Next(Time now, const CoilInertialFilter& filter,
                                          bool may_pulse = true);

  /// Part of the time until `now` in which a coil was on.
  [[nodiscard]] double Duty(Time now) const;

 private:
  CoilPulsePlanner(const CoilPlannerConfig& config, const CoilInertialConfig& filter)
      : config_(config), source_(filter.source), sigma_mag_tesla_(filter.sigma_mag_tesla) {}

  [[nodiscard]] bool Wanted(Time now, const CoilInertialFilter& filter) const;
  [[nodiscard]] Pulse Best(const CoilInertialFilter& filter) const;

  CoilPlannerConfig config_;
  sensing::CoilSource source_;
  double sigma_mag_tesla_;
  std::optional<Time> first_at_;
  std::optional<Time> asked_at_;
  std::optional<Time> pulsed_at_;
  double saved_s_ = 0.0;  // of on-time
  double on_s_ = 0.0;
  int turn_ = 0;
};

}  // namespace limbcast::filters
