#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "common/base/result.hpp"
#include "common/filters/attitude_watchdog.hpp"
#include "common/filters/filter.hpp"
#include "common/filters/gauss_newton_config.hpp"
#include "common/filters/gauss_newton_core.hpp"
#include "common/filters/sample_gate.hpp"
#include "common/filters/two_vector_start.hpp"

namespace limbcast::filters {

/// The quaternion complementary filter of Bachmann, McGhee et al. ("tqt"): rates are integrated,
/// and a Gauss–Newton step on gravity and field pulls the result back with gain k [B·15]:
///
///   q ← normalise(q⁻ + q⁻⊗(0, α Δv)),  q⁻ = q ⊗ Exp(ω dt),  α = min(k·dt, 1)
///
/// The step is taken at q⁻, so that measured and computed vectors belong to the same instant.
/// Without gyro readings for more than 50 ms, accelerometer and magnetometer alone are tracked:
/// α = 1 and at least three steps. Without magnetometer ρ is 0 and heading drifts with the gyro.
///
/// The filter has no covariance. `cov_orientation_rad2` is the honest equivalent: the variance of a
/// scalar filter with the same fixed gain for tilt and for heading, fed with disturbance densities
/// of moving limbs (constants in the .cpp). Thread-compatible; allocates nothing after
/// construction.
///
/// Scalar: arithmetic of the core, double or float.
template <typename Scalar>
class GaussNewtonOrientation final : public OrientationFilter {
 public:
  /// @param config  valid.
  explicit GaussNewtonOrientation(const GaussNewtonConfig& config);

  [[nodiscard]] SampleVerdict Update(const sensing::MargSample& sample) override;
  [[nodiscard]] const FilterEstimate& estimate() const override { return state_.estimate; }
  void Reset() override;
  [[nodiscard]] std::string_view name() const override { return "tqt"; }
  [[nodiscard]] std::size_t state_size_bytes() const override;
  void SaveState(std::span<std::byte> out) const override;
  [[nodiscard]] Status RestoreState(std::span<const std::byte> in) override;

  using Config = GaussNewtonConfig;
  using Number = Scalar;
  using CoreInput = GaussNewtonInput<Scalar>;
  using CoreState = GaussNewtonState<Scalar>;

  /// Update in parts, for a batch that steps the core of several filters at once.
  ///
  /// What a sample asks for: nothing (the verdict is said), a plain step of the core, or more.
  [[nodiscard]] SampleStep Pass(const sensing::MargSample& sample);
  /// After a plain one: the input of the core's step.
  [[nodiscard]] const CoreInput& core_input() const { return input_; }
  /// Instead of the step, whatever was asked for; takes the core as it is in this filter.
  SampleVerdict StepAlone();
  /// After none.
  [[nodiscard]] SampleVerdict refusal() const { return gated_.verdict; }
  /// After the step.
  SampleVerdict Report();

  [[nodiscard]] const Config& config() const { return config_; }
  [[nodiscard]] CoreState& core_state() { return state_.core; }
  /// Calls copy(member) for what Report needs of the core.
  template <typename Copy>
  static void ForEachReported(CoreState& core, Copy copy) {
    copy(core.q_ES);
    copy(core.w_ES_S_rad_s);
    copy(core.free_accel_E_m_s2);
    copy(core.null_rad_s);
    copy(core.rest.still_s);
    copy(core.field_mean_square);
    copy(core.var_tilt_rad2);
    copy(core.var_heading_rad2);
  }

 private:
  struct State {
    FilterEstimate estimate;
    SampleGate gate;
    TwoVectorStart start;
    AttitudeWatchdog watchdog;
    CoreState core{};
    double heading_before_rad = 0.0;  // of a restart
    bool starting = true;
    bool lost = false;  // the restart under way forgets the gyro null
  };

  void BeginRestart();
  void CheckAttitude();
  SampleVerdict UpdateStart();
  void AdoptField(const Eigen::Vector3d& mag_in_earth_tesla);
  GaussNewtonConfig config_;
  State state_;
  GatedSample gated_;  // the one in work
  CoreInput input_{};
};

extern template class GaussNewtonOrientation<double>;
extern template class GaussNewtonOrientation<float>;

/// A GaussNewtonOrientation in the precision that `config` asks for.
[[nodiscard]] std::unique_ptr<OrientationFilter> MakeGaussNewtonOrientation(
    const GaussNewtonConfig& config);

}  // namespace limbcast::filters
