#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "common/base/result.hpp"
#include "common/filters/position/coil_inertial_config.hpp"
#include "common/filters/position/coil_inertial_states.hpp"
#include "common/filters/position/coil_measurement.hpp"
#include "common/filters/position/coil_motion_solver.hpp"
#include "common/filters/position/coil_pulse_collector.hpp"
#include "common/sensing/coil_frame.hpp"

namespace limbcast::filters {

/// What the filter is at.
enum class CoilPhase : std::uint8_t {
  kLevelling,  ///< waits for rest, for the first attitudes
  kAcquiring,  ///< attitudes run on inertia; waits for three pulses that give a pose
  kTracking,   ///< the estimate is valid
};

/// What became of a frame.
enum class CoilFrameVerdict : std::uint8_t {
  kUsed,
  kInertialOnly,        ///< no magnetometer reading: missing, clipped, not settled, or rejected
  kRejectedOutOfOrder,  ///< not later than the one before; nothing was done
  kHeld,                ///< inertial readings not finite: the last ones were used again
};

struct CoilUpdateReport {
  CoilFrameVerdict verdict = CoilFrameVerdict::kUsed;
  CoilPhase phase = CoilPhase::kLevelling;
  GateOutcome gate = GateOutcome::kFused;
  double nis = 0.0;        ///< of the magnetometer sample; mean 3 when all is well
  bool lost = false;       ///< track was lost at this frame
  bool acquired = false;   ///< a track begins at this frame
  bool disturbed = false;  ///< the background is not the earth's
  /// The source says that a coil is on, and the field says that none is: the sample was not used.
  bool coil_silent = false;
  bool coil_alarm = false;  ///< one of the coils was silent in its last three pulses or more
  bool rebuilt = false;     ///< the covariance was not positive: only its diagonal was kept
};

/// Position and orientation of a sensor from a source of three coils, tightly coupled with the
/// inertial units of both (design/position.md section 10): every magnetometer sample is a
/// measurement when it arrives. Iterated update, gauge pinning, moving or fixed source, loss of
/// track and re-acquisition. Starts by itself: rest, then the first three pulses.
///
/// Earth frame: z up, heading arbitrary (the first magnetic north). Allocates nothing.
/// Thread-compatible; a copy goes on by itself.
class CoilInertialFilter {
 public:
  [[nodiscard]] static Result<CoilInertialFilter> Make(const CoilInertialConfig& config);

  CoilUpdateReport Update(const sensing::CoilFrame& frame);

  [[nodiscard]] CoilPhase phase() const { return phase_; }
  [[nodiscard]] const CoilInertialState& state() const { return state_; }
  [[nodiscard]] const CoilCovariance& covariance() const { return P_; }
  /// How the last frame was reached, for smoothing: its transition and magnetometer sample, then
  /// gauges with a transition of nothing. Empty unless tracking.
  [[nodiscard]] std::span<const CoilRecord> records() const {
    return {records_.data(), record_count_};
  }
  [[nodiscard]] int losses() const { return losses_; }
  /// Times that the covariance was rebuilt.
  [[nodiscard]] int rebuilds() const { return rebuilds_; }

  /// For loose coupling (LooseCoilFilter). Takes a pose of the newest frame, `H` and `nu` in
  /// `record`; records() does not know of it.
  UpdateReport Correct(const SoftGateConfig& gate, const Eigen::Matrix<double, 6, 6>& R_noise,
                       CoilPoseRecord& record);
  /// The same: gives the track up, as when the filter itself finds it lost.
  void LoseTrack() {
    CoilUpdateReport report;
    Lose(report);
  }

  /// Whether surprises between pulses let the background walk faster (as they do at first). Not
  /// where two filters are compared by what surprises them.
  void HeedSurprise(bool heed) { heeds_surprise_ = heed; }

  /// From now on the side of a new track is that of the last one.
  void ForgetHalfSpace() { config_.half_space.reset(); }

  /// Displaces the estimate without telling the covariance; for tests of recovery.
  void Disturb(const CoilVector& error) { state_ = Plus(state_, error); }
  /// Overwrites the covariance; for tests of recovery.
  void DisturbCovariance(const CoilCovariance& P) { P_ = P; }

 private:
  explicit CoilInertialFilter(const CoilInertialConfig& config);

  void Level(const sensing::CoilFrame& frame);
  void Propagate(const sensing::CoilFrame& frame, double dt_s, double inflation);
  void Acquire(const sensing::CoilFrame& frame, CoilUpdateReport& report);
  void BeginTrack(const sensing::CoilFrame& frame, const CoilPose& pose);
  void Resume(const sensing::CoilFrame& frame, const CoilMotion& motion);
  void EnterTracking(const sensing::CoilFrame& frame);
  void UseSample(const sensing::CoilFrame& frame, CoilUpdateReport& report);
  [[nodiscard]] double Unrest() const;
  void WatchBackground(double nis);
  [[nodiscard]] bool FitsWithoutCoil(const sensing::CoilFrame& frame) const;
  /// A further measurement of this instant: to be filled in, and then used.
  [[nodiscard]] MeasurementRecord<CoilInertialIndex::kAll, 3>& Further();
  void UseFurther(const SoftGateConfig& gate, double sigma);
  void UseEmitterSample(const sensing::CoilFrame& frame);
  void UseGauges(const sensing::CoilFrame& frame);
  [[nodiscard]] double SigmaGravity_m_s2() const;
  void GuardCovariance(CoilUpdateReport& report);
  /// √(tr P_pp) is within `lost_relative_sigma` of |p|.
  [[nodiscard]] bool IsCertain() const;
  void WatchTrack(const sensing::CoilFrame& frame, CoilUpdateReport& report);
  void WatchPulses(const sensing::CoilFrame& frame, bool over, CoilUpdateReport& report);
  [[nodiscard]] bool IsPulseOver(const sensing::CoilFrame& frame);
  void Lose(CoilUpdateReport& report);
  [[nodiscard]] CoilPath PathNow() const {
    return {state_.q_earth_sensor, state_.q_earth_emitter, state_.p_earth_m};
  }

  CoilInertialConfig config_;
  CoilPhase phase_ = CoilPhase::kLevelling;
  CoilInertialState state_;
  CoilCovariance P_ = CoilCovariance::Zero();
  CoilPulseCollector collector_;
  std::optional<sensing::CoilFrame> last_;
  InertialBlock sensor_block_;
  InertialBlock emitter_block_;
  std::array<CoilRecord, 4> records_;
  std::size_t record_count_ = 0;

  // Levelling: sums since rest began.
  struct Sums {
    Eigen::Vector3d accel = Eigen::Vector3d::Zero();
    Eigen::Vector3d gyro = Eigen::Vector3d::Zero();
    Eigen::Vector3d mag = Eigen::Vector3d::Zero();
    Eigen::Vector3d emitter_accel = Eigen::Vector3d::Zero();
    Eigen::Vector3d emitter_gyro = Eigen::Vector3d::Zero();
    int count = 0;
    int mag_count = 0;
  } sums_;
  Time begun_at_{};
  Time rest_since_{};

  Eigen::Vector3d background_start_tesla_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d agreed_emitter_m_ =
      Eigen::Vector3d::Zero();  // where pulses agreed with the track
  Time agreed_at_{};
  Time gravity_at_{};
  Time background_at_{};
  Time source_on_at_{};  // last time that a coil was on, or settled
  Time disturbed_until_{};
  bool heeds_surprise_ = true;
  double background_nis_ = 1.0;  // NIS/3 of samples without a coil, mean of the last ones
  bool ever_tracked_ = false;
  bool at_rest_ = true;  // since levelling: the first pose may take it that nothing moves
  // NIS of the pulse that is on, and of the last three.
  double pulse_nis_ = 0.0;
  int pulse_samples_ = 0;
  std::array<double, 3> pulse_means_{};
  std::array<double, 4> pulse_firsts_{};  // NIS of the first sample of each
  int pulses_seen_ = 0;
  int silent_samples_ = 0;               // of the pulse that is on
  int pulsed_coil_ = -1;                 // the coil of that pulse
  int silent_pulses_ = 0;                // in a row, of any coil
  std::array<int, 4> silent_of_coil_{};  // in a row, of each; of all with tones
  Time window_begun_at_{};               // of tones
  int rejected_in_a_row_ = 0;
  int losses_ = 0;
  int rebuilds_ = 0;
  int attempts_ = 0;  // of this re-acquisition
};

}  // namespace limbcast::filters
