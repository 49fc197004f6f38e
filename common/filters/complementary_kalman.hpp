#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "common/base/result.hpp"
#include "common/filters/attitude_watchdog.hpp"
#include "common/filters/complementary_kalman_model.hpp"
#include "common/filters/field_monitor.hpp"
#include "common/filters/filter.hpp"
#include "common/filters/filter_settings.hpp"
#include "common/filters/rest_detector.hpp"
#include "common/filters/sample_gate.hpp"
#include "common/filters/two_vector_start.hpp"

namespace limbcast::filters {

/// Which covariances are kept from one update to the next: all, or the published blocks, which
/// cannot learn the gyro bias.
enum class KalmanStructure { kFull = 0, kThesis = 1 };

/// What the disturbance noise is made of: the field's deviation from the reference, or its change
/// since the last sample as published.
enum class DisturbanceMeasure { kDeviation = 0, kChange = 1 };

/// Tuning of ComplementaryKalman. Poles and noises are per 10 ms and are rescaled to the sample
/// rate; fields are in units of the reference field (`_ref`).
struct ComplementaryKalmanConfig {
  KalmanStructure structure = KalmanStructure::kFull;
  DisturbanceMeasure disturbance_measure = DisturbanceMeasure::kDeviation;
  /// The magnetic disturbance as a state; false is the plain filter, for comparison ("ckf-plain").
  bool use_disturbance = true;

  double init_time_s = 0.5;  ///< Range: [0, 10].
  /// Effective gyro noise, scale errors included. Range: (0, 10].
  double sigma_gyro_rad_s = 0.037;
  /// Random walk and initial std of the gyro bias. Range: [0, 1].
  double walk_gyro_bias_rad_s = 2e-7;
  double sigma_gyro_bias_start_rad_s = 0.005;
  /// Pole and drive of the acceleration model. Ranges: [0, 1), (0, 100].
  double pole_accel = 0.3;
  double drive_accel_m_s2 = 5.0;
  /// Sensor noise; the magnetometer's holds un-modelled inhomogeneity of the field. Range: (0, 10].
  double sigma_accel_m_s2 = 0.05;
  double sigma_mag_ref = 0.27;
  /// Pole of the disturbance, and its drive by error of norm, by error of dip, and always.
  /// Ranges: [0, 1], [0, 10].
  double pole_disturbance = 0.98;
  double drive_norm = 0.07;
  double drive_dip_per_rad = 0.03;
  double drive_floor_ref = 1e-6;
  /// Initial std of the orientation. Range: (0, 3].
  double sigma_orientation_start_rad = 0.1;
};

/// The fields of ComplementaryKalmanConfig by name, with their ranges.
[[nodiscard]] std::span<const SettingField<ComplementaryKalmanConfig>> ComplementaryKalmanFields();
[[nodiscard]] Status Validate(const ComplementaryKalmanConfig& config);

/// The complementary Kalman filter of D. Roetenberg, "Inertial and magnetic sensing of human
/// motion" (2006), chapters 2 and 3 ("ckf", "ckf-plain"), with the corrections of
/// design/orientation.md section 4: gyro integration, against which a nine-state error filter holds
/// gravity (with a first-order model of the acceleration) and field (with a first-order model of
/// the disturbance), both kept in the earth frame. Thread-compatible; allocates nothing after
/// construction.
class ComplementaryKalman final : public OrientationFilter {
 public:
  /// @param config  valid.
  explicit ComplementaryKalman(const ComplementaryKalmanConfig& config);

  [[nodiscard]] SampleVerdict Update(const sensing::MargSample& sample) override;
  [[nodiscard]] const FilterEstimate& estimate() const override { return state_.estimate; }
  void Reset() override;
  [[nodiscard]] std::string_view name() const override {
    return config_.use_disturbance ? "ckf" : "ckf-plain";
  }
  [[nodiscard]] std::size_t state_size_bytes() const override;
  void SaveState(std::span<std::byte> out) const override;
  [[nodiscard]] Status RestoreState(std::span<const std::byte> in) override;

  /// The disturbance estimate in earth axes, units of the reference field.
  [[nodiscard]] const Eigen::Vector3d& disturbance_E_ref() const { return state_.d_E; }
  /// How often the covariance lost its meaning and was set back.
  [[nodiscard]] std::uint64_t covariance_resets() const { return state_.covariance_resets; }

 private:
  struct State {
    FilterEstimate estimate;
    SampleGate gate;
    TwoVectorStart start;
    RestDetector rest;
    AttitudeWatchdog watchdog;
    FieldMonitor field;
    Matrix9 P = Matrix9::Zero();
    Eigen::Matrix3d cov_accel = Eigen::Matrix3d::Zero();  // Q_a⁺ in S, (m/s²)²
    Eigen::Vector3d a_E = Eigen::Vector3d::Zero();
    Eigen::Vector3d d_E = Eigen::Vector3d::Zero();
    Eigen::Vector3d m0_E = Eigen::Vector3d::UnitY();  // unit
    double inverse_field_tesla = 0.0;
    double norm_low = 1.0;  // of the field, 10 Hz low-pass
    double dip_low_rad = 0.0;
    double heading_before_rad = 0.0;  // of a restart
    std::uint64_t covariance_resets = 0;
    bool has_field = false;
    bool starting = true;
  };
  // Poles and noises for one step length.
  struct Step {
    double dt_s = 0.0;
    double c_a = 0.0;
    double c_d = 0.0;
    double ratio = 0.0;  // step / 10 ms
  };

  void BeginRestart();
  void CheckAttitude(const GatedSample& sample);
  SampleVerdict UpdateStart(const GatedSample& sample);
  void AdoptField(const Eigen::Vector3d& mag_in_earth_tesla);
  void SetStep(double dt_s);
  void Predict(const GatedSample& sample);
  [[nodiscard]] double DisturbanceDrive(const GatedSample& sample, bool use_field);
  void Correct(const GatedSample& sample, bool use_field);
  void Inject(const Vector9& x);
  void DetectRest(const GatedSample& sample);
  void GuardCovariance();
  void ResetCovariance();
  void Report(const GatedSample& sample, bool use_field);

  ComplementaryKalmanConfig config_;
  Step step_;
  State state_;
};

}  // namespace limbcast::filters
