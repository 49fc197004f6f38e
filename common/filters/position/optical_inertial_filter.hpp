#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

#include "common/base/time.hpp"
#include "common/base/verdict.hpp"
#include "common/filters/position/inertial_gate.hpp"
#include "common/filters/position/known_attitude_start.hpp"
#include "common/filters/position/marker_gate.hpp"
#include "common/filters/position/optical_inertial_config.hpp"
#include "common/filters/position/optical_inertial_states.hpp"
#include "common/filters/position/optical_start.hpp"

namespace limbcast::filters {

/// An epoch of the filter: the end of a covariance block, after the marker that belongs to it.
struct OpticalEpoch {
  Time at{};
  OpticalInertialState state;                                     ///< X⁺
  Eigen::Vector3d accel_in_earth_m_s2 = Eigen::Vector3d::Zero();  ///< of the sensor, R f + g
  Eigen::Vector3d w_earth_sensor_in_sensor_rad_s = Eigen::Vector3d::Zero();
  optical::Covariance P = optical::Covariance::Zero();  ///< P⁺
  /// ∂(acceleration)/∂(error state): what a correction of the state does to accel_in_earth_m_s2.
  Eigen::Matrix<double, 3, optical::kStates> accel_rows;
  optical::Record record;
  bool had_marker = false;  ///< a marker was fused, with full or less weight
  double nis = 0.0;         ///< of that marker (3 = consistent), before any scaling
  bool degraded = false;    ///< inertial readings were held, saturated or missing on the way here
};

/// What Add says of an inertial sample.
struct OpticalStep {
  SampleVerdict verdict = SampleVerdict::kNoData;
  bool epoch_closed = false;  ///< epoch() is a new one
  bool restarted = false;     ///< the filter started (again) here
};

/// Error-state Kalman filter of an inertial unit that carries one optical marker: position,
/// velocity, attitude and sensor errors in the frame of the optical system, of which only the
/// direction of gravity needs to be known roughly (design/position.md sections 2 to 4). It keeps
/// running through gaps of the marker. Gating is soft: a marker is never locked out for good.
///
/// Feed markers and inertial samples in the order of their times; a marker is fused with the block
/// into which its stamp falls, so push it before the inertial sample that ends at or after its
/// time.
///
/// Time comes with the samples. Allocates nothing after construction. Thread-compatible.
class OpticalInertialFilter {
 public:
  /// @param config  valid.
  explicit OpticalInertialFilter(const OpticalInertialConfig& config);

  MarkerVerdict AddMarker(const sensing::MarkerPosition& sample);
  /// @param q_known  attitude in the optical frame that somebody else knows at this sample (about
  ///                 10° in heading, 2° in tilt): a filter that is not started then starts from it
  ///                 and the markers of a quarter of a second, in motion or at rest.
  OpticalStep AddInertial(const sensing::MargSample& sample,
                          const std::optional<Eigen::Quaterniond>& q_known = std::nullopt);

  /// Starts here, without looking for attitude: at `at`, with the covariance of the configuration.
  void Start(Time at, const OpticalInertialState& state);

  [[nodiscard]] bool started() const { return started_; }
  /// The last closed epoch; meaningful once started().
  [[nodiscard]] const OpticalEpoch& epoch() const { return epoch_; }
  /// The state at the last inertial sample, at most a block past epoch().
  [[nodiscard]] const OpticalInertialState& state() const { return state_; }
  [[nodiscard]] const Eigen::Vector3d& accel_in_earth_m_s2() const { return accel_E_; }
  [[nodiscard]] Time at() const { return at_; }

  [[nodiscard]] const OpticalInertialConfig& config() const { return config_; }
  [[nodiscard]] const VerdictCounters& inertial_counters() const { return inertial_counters_; }
  [[nodiscard]] const MarkerCounters& marker_counters() const { return marker_counters_; }
  /// How often the covariance had to be rebuilt, and the filter restarted.
  [[nodiscard]] std::uint64_t covariance_rebuilds() const { return covariance_rebuilds_; }
  [[nodiscard]] std::uint64_t restarts() const { return restarts_; }
  [[nodiscard]] const std::optional<OpticalStartResult>& start() const { return start_result_; }

 private:
  void StartFrom(Time at, const NavigationState& navigation,
                 const Eigen::Vector3d& gyro_bias_rad_s);
  [[nodiscard]] bool LookForStart(Time at, const GatedInertial& inertial,
                                  const std::optional<Eigen::Quaterniond>& q_known);
  void ResetCovariance();
  void CrossDropout(double dt_s, Time at);
  void CloseBlock(Time at);
  void DecayBiases(double dt_s);
  void FuseMarker(const TimedMarker& marker);
  [[nodiscard]] bool Recover(const TimedMarker& marker, Eigen::Vector3d& nu);
  void Restart();
  void FillEpoch();
  [[nodiscard]] bool GuardHealth();

  OpticalInertialConfig config_;
  InertialNoise noise_;
  InertialGate inertial_gate_;
  MarkerGate marker_gate_;
  OpticalStart start_;
  KnownAttitudeStart known_start_;
  std::optional<OpticalStartResult> start_result_;
  OutlierRun outliers_;
  bool doubted_ = false;  // outliers_ went on until the filter was in doubt
  Time doubted_at_{};
  Time last_marker_at_{};
  double misfit_s_ = 0.0;  // without agreement, less what agreement paid back

  bool started_ = false;
  bool chain_begins_ = false;
  OpticalInertialState state_;
  optical::Covariance P_ = optical::Covariance::Zero();
  InertialReading last_;
  Eigen::Vector3d accel_E_ = Eigen::Vector3d::Zero();
  Time at_{};
  InertialBlock block_;
  double block_noise_factor_ = 1.0;
  OpticalEpoch epoch_;

  VerdictCounters inertial_counters_;
  MarkerCounters marker_counters_;
  std::uint64_t covariance_rebuilds_ = 0;
  std::uint64_t restarts_ = 0;
};

}  // namespace limbcast::filters
