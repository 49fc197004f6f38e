#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "common/filters/bounded_motion_config.hpp"
#include "common/filters/lanes.hpp"
#include "common/filters/lendable.hpp"
#include "common/filters/packed_symmetric.hpp"

namespace limbcast::filters {

/// One reading as the core takes it, of one sensor or of as many as Scalar has lanes (lanes.hpp).
/// What is not usable is left out by its flag, never by a number. Nothing but Scalar, flags too.
template <typename Scalar>
struct BoundedMotionInput {
  using Vector3 = Eigen::Matrix<Scalar, 3, 1, Eigen::DontAlign>;
  Scalar dt_s = 0;
  Vector3 gyro_rad_s;
  Vector3 accel_m_s2;
  Vector3 mag;  ///< any unit, always the same
  Scalar accel_valid = 1;
  Scalar mag_valid = 1;
  Scalar rest_allowed = 1;  ///< 0: the gyro value is not a reading
  Scalar present = 1;       ///< 0 leaves a lane of a batch as it is
};

/// What every sample changes.
template <typename Scalar>
struct BoundedMotionFastState {
  using Vector3 = Eigen::Matrix<Scalar, 3, 1, Eigen::DontAlign>;
  using Matrix3 = Eigen::Matrix<Scalar, 3, 3, Eigen::DontAlign>;

  Eigen::Quaternion<Scalar, Eigen::DontAlign> q_ES;
  Vector3 w_ES_S;  // last rate, corrected

  // sums since the last slow step
  Matrix3 sum_R;
  Vector3 sum_f, sum_m;
  Eigen::Matrix<Scalar, 3, 9, Eigen::DontAlign> sum_W;  // Σ R ω'_j dt
  Scalar sum_w2, sum_t;
  Scalar n, n_f, n_m;  // samples

  // rest detector
  Vector3 low_g, low_a;
  Scalar rest_time_s;
  Scalar low_started;  // flag
};

/// Everything the core remembers; trivially copyable, so that it can be saved, restored and
/// compared. Nothing but Scalar, flags and counts too, without gaps between them.
///
/// Error convention: R_true = Exp(δθ)·R̂ (earth frame), every other error is truth − estimate.
/// Order of the error vector: δθ 0–2, δb_g 3–5, δv_h 6–7, δp_h 8–9, δb_a 10–12, δb_m 13–15, δS
/// 16–24 (by columns), δm_0 25–26 (north, up).
template <typename Scalar>
struct BoundedMotionState : BoundedMotionFastState<Scalar> {
  static constexpr int kDim = 27;
  using Vector3 = typename BoundedMotionFastState<Scalar>::Vector3;
  using Matrix3 = typename BoundedMotionFastState<Scalar>::Matrix3;

  Vector3 b_g, b_a, b_m;
  Matrix3 S;
  Eigen::Matrix<Scalar, 2, 1, Eigen::DontAlign> v_h, p_h;
  Vector3 m_0;       // reference field, units of |m| at start: (0, north, up)
  Scalar m_ref;      // |m| at start, unit of the input
  Scalar has_field;  // flag
  Scalar sum_extra_theta;

  // field check
  Scalar deviation_hold, deviation_mean;
  Scalar east_mean, east_scatter2;  // of the field without the carried one, units of m_ref
  Scalar scatter_s;                 // time of motion behind them, at most scatter_time_s
  Scalar covariance_resets;
  Scalar slow_steps;  // exact up to 2^24 in single precision

  PackedSymmetric<Scalar, kDim> P;
};

/// The steps of BoundedMotionCore on a state that belongs to somebody else: the algorithm, for one
/// sensor or for several lanes.
template <typename Scalar>
class BoundedMotionStep {
 public:
  using State = BoundedMotionState<Scalar>;
  using Input = BoundedMotionInput<Scalar>;
  using Vector3 = Eigen::Matrix<Scalar, 3, 1>;
  using Matrix3 = Eigen::Matrix<Scalar, 3, 3>;
  using Mask = lanes::MaskOf<Scalar>;

  BoundedMotionStep(const BoundedMotionConfig& config, State& state)
      : config_(config), state_(state) {}

  /// The two steps of one sample: integrate, and correct when a slow step is complete.
  void Update(const Input& input);

  void ResetCovariance();
  void ClearSums();
  [[nodiscard]] Mask AtRest() const { return state_.rest_time_s > Scalar(kRestAfter_s); }

  static constexpr double kRestAfter_s = 1.5;

 private:
  static constexpr int kDim = State::kDim;
  static constexpr int kRows = 28;  // padded, so that every column starts aligned
  struct Means;

  void Integrate(const Input& input);
  void DetectRest(const Input& input);
  void SlowStep();
  void Propagate(const Means& means);
  void CheckField(const Means& means);
  void CorrectRest(Scalar T);
  void CorrectBounds(Scalar T);
  void CorrectField(const Means& means);
  template <int N>
  void CorrectDirect(Mask where, int first, const Eigen::Matrix<Scalar, N, 1>& z, Scalar variance);
  void Inject(const Eigen::Matrix<Scalar, kRows, 1>& dx);
  void GuardCovariance();

  const BoundedMotionConfig& config_;
  State& state_;
  // Both halves of the covariance, zero below the first kDim rows: only during a slow step.
  Eigen::Matrix<Scalar, kRows, kDim, Eigen::DontAlign> P_;
};

/// The bounded-motion multi-rate error-state Kalman filter of one sensor, without time stamps and
/// bad input (see BoundedMotionFilter for those). Attitude is integrated with every sample;
/// covariance and corrections run at the slow rate on sums over the samples in between. Earth
/// frame: ENU. Thread-compatible; allocates nothing.
template <typename Scalar>
class BoundedMotionCore {
 public:
  using State = BoundedMotionState<Scalar>;
  using Input = BoundedMotionInput<Scalar>;
  using Vector3 = Eigen::Matrix<Scalar, 3, 1>;

  /// @param config  valid.
  explicit BoundedMotionCore(const BoundedMotionConfig& config);

  /// Starts (or restarts) the attitude; keeps b_g, S and b_a when `keep_learned`.
  ///
  /// @param q_earth_sensor  unit.
  /// @param mag_in_earth    mean field turned to the earth frame by q_earth_sensor, or zero when
  /// there is none.
  void Start(const Eigen::Quaternion<Scalar>& q_earth_sensor, const Vector3& mag_in_earth,
             bool keep_learned);

  /// The two steps of one sample: integrate, and correct when a slow step is complete.
  void Update(const Input& input) { step().Update(input); }

  /// The field reference from the first usable magnetometer readings, when the start had none:
  /// heading stays where it is.
  void AdoptField(const Vector3& mag_in_earth);

  /// Turns the attitude about the vertical, e.g. to the north of a field that is seen for the first
  /// time; heading is then as uncertain as at a start.
  void TurnHeading(const Eigen::Quaternion<Scalar>& q_turn);

  /// Adds to the attitude variance (all axes) with the next slow step, e.g. for a bridged gap.
  void InflateAttitude(Scalar variance_rad2) { state_->sum_extra_theta += variance_rad2; }

  /// Adds to the heading variance at once, e.g. for a start beside iron.
  void InflateHeading(Scalar variance_rad2) { state_->P(2, 2) += variance_rad2; }

  [[nodiscard]] const State& state() const { return *state_; }
  [[nodiscard]] State& mutable_state() { return *state_; }
  /// The state moves to a place that others use, too, see Lendable.
  void LendState(State& place) { state_.Lend(place); }
  [[nodiscard]] bool at_rest() const {
    return state_->rest_time_s > static_cast<Scalar>(BoundedMotionStep<Scalar>::kRestAfter_s);
  }
  [[nodiscard]] const BoundedMotionConfig& config() const { return config_; }

 private:
  [[nodiscard]] BoundedMotionStep<Scalar> step() { return {config_, *state_}; }

  BoundedMotionConfig config_;
  Lendable<State> state_;
};

extern template class BoundedMotionStep<double>;
extern template class BoundedMotionStep<float>;
extern template class BoundedMotionCore<double>;
extern template class BoundedMotionCore<float>;

}  // namespace limbcast::filters
