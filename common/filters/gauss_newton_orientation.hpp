#pragma once

#include <cstdint>
#include <span>

#include "common/base/result.hpp"
#include "common/filters/attitude_watchdog.hpp"
#include "common/filters/field_monitor.hpp"
#include "common/filters/filter.hpp"
#include "common/filters/filter_settings.hpp"
#include "common/filters/rest_detector.hpp"
#include "common/filters/sample_gate.hpp"
#include "common/filters/two_vector_start.hpp"

namespace limbcast::filters {

/// Which of the published Gauss–Newton steps is taken; both lead to the same estimate.
enum class GaussNewtonForm { kReduced3x3 = 0, kFull4x4 = 1 };

/// How rates become rotations. The Euler step of the publications under-rotates by 3e-3 at 0.2 rad
/// per sample; kAuto takes it below 0.02 rad per sample and the exponential above.
enum class RateIntegration { kAuto = 0, kEuler = 1, kExponential = 2 };

/// Tuning of GaussNewtonOrientation. The defaults suit a body-worn MARG sensor at 1–1000 Hz.
struct GaussNewtonConfig {
  GaussNewtonForm form = GaussNewtonForm::kReduced3x3;
  RateIntegration integration = RateIntegration::kAuto;

  /// Feedback gain k; crossover frequency k/2π. Large values trust accelerometer and magnetometer,
  /// small values the gyro; published 0.1–4. 0 = automatic: 0.04 once the gyro null is known, 0.3
  /// before. Range: [0, 100].
  double k_per_s = 0.0;

  /// Emphasis of the magnetometer; 1 = the published equal weight, 0 = heading from the gyro alone.
  /// Range: [0, 10].
  double rho = 0.45;

  /// The gyro null is the mean over the first rest of this length; a sensor that is not at rest is
  /// not calibrated. 0 = off. Range: [0, 60].
  double null_time_s = 2.0;

  /// Gauss–Newton steps per sample. Range: [1, 20].
  int iterations = 1;

  /// Time over which the start is averaged. Range: [0, 10].
  double init_time_s = 0.5;
};

/// The fields of GaussNewtonConfig by name, with their ranges.
[[nodiscard]] std::span<const SettingField<GaussNewtonConfig>> GaussNewtonFields();
[[nodiscard]] Status Validate(const GaussNewtonConfig& config);

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

 private:
  struct State {
    FilterEstimate estimate;
    SampleGate gate;
    TwoVectorStart start;
    RestDetector rest;
    AttitudeWatchdog watchdog;
    FieldMonitor field;
    Eigen::Vector3d null_sum_rad_s = Eigen::Vector3d::Zero();
    Eigen::Vector3d reference_field = Eigen::Vector3d::UnitY();  // n, unit
    double inverse_field_tesla = 0.0;                            // 1 / |m| at start
    double heading_before_rad = 0.0;                             // of a restart
    double var_tilt_rad2 = 0.0;
    double var_heading_rad2 = 0.0;
    std::uint64_t null_count = 0;
    bool null_known = false;
    bool has_field = false;
    bool starting = true;
  };

  void BeginRestart();
  void CheckAttitude(const GatedSample& sample);
  SampleVerdict UpdateStart(const GatedSample& sample);
  void AdoptField(const Eigen::Vector3d& mag_in_earth_tesla);
  void CalibrateNull(const GatedSample& sample);
  void SpreadVariance(const GatedSample& sample, bool use_field, double gain, double rate_per_s);
  void Report(const GatedSample& sample, bool use_field);
  [[nodiscard]] double GainRate_per_s() const;

  GaussNewtonConfig config_;
  State state_;
};

}  // namespace limbcast::filters
