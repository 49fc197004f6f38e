#include "common/filters/position/optical_inertial_filter.hpp"

#include <algorithm>
#include <cmath>

#include "common/base/expects.hpp"
#include "common/filters/position/marker_measurement.hpp"

namespace limbcast::filters {
namespace {

using namespace optical;

constexpr double kDropoutSpeedStd_m_s = 1.0;   // design/position.md section 13
constexpr double kDropoutRateStd_rad_s = 0.5;  // how fast a limb turns while nobody looks
constexpr double kMaxCrossed_s = 1.0;          // a longer dropout loses the attitude: start again
constexpr double kMaxMarkerAge_s = 0.02;       // a later one cannot be brought to the state
constexpr double kLateJerk_m_s3 = 500.0;       // error of bringing it there: |t|³/6 of this
constexpr double kMisfit_s = 1.0;              // so long without agreement: the filter is in doubt
constexpr double kAgreementPays = 4.0;         // a fused marker makes up for so many that are not
constexpr double kMaxMisfitStep_s = 0.1;       // of one marker after a gap
constexpr double kDoubtAgain_s = 10.0;
constexpr double kMinVariance = 1e-18;   // below, an estimated state counts as not positive
constexpr double kMaxSpeed_m_s = 100.0;  // beyond: the filter is lost

double Squared(double x) { return x * x; }

InertialNoise NoiseOf(const OpticalInertialConfig& c) {
  return {.sigma_accel_m_s2_rthz = c.sigma_accel_m_s2_rthz,
          .sigma_gyro_rad_s_rthz = c.sigma_gyro_rad_s_rthz,
          .walk_accel_bias_m_s3_rthz = c.walk_accel_bias_m_s3_rthz,
          .walk_gyro_bias_rad_s2_rthz = c.walk_gyro_bias_rad_s2_rthz,
          .k_accel = c.k_accel,
          .k_rate = c.k_rate,
          .k_accel_bend = c.k_accel_bend,
          .k_rate_bend = c.k_rate_bend,
          .tau_accel_bias_s = c.tau_accel_bias_s,
          .tau_gyro_bias_s = c.tau_gyro_bias_s};
}

double DecayOver(double dt_s, double tau_s) { return tau_s > 0.0 ? std::exp(-dt_s / tau_s) : 1.0; }

}  // namespace

OpticalInertialFilter::OpticalInertialFilter(const OpticalInertialConfig& config)
    : config_(config),
      noise_(NoiseOf(config)),
      inertial_gate_(config.accel_range_m_s2, config.gyro_range_rad_s),
      start_(config.gravity_m_s2),
      known_start_(config.gravity_m_s2,
                   {config.lever_arm_x_m, config.lever_arm_y_m, config.lever_arm_z_m}) {
  Expects(Validate(config).ok(), "a valid OpticalInertialConfig");
}

MarkerVerdict OpticalInertialFilter::AddMarker(const sensing::MarkerPosition& sample) {
  MarkerVerdict verdict = marker_gate_.Push(sample);
  if (verdict == MarkerVerdict::kQueued && started_ &&
      ToSeconds(at_ - sample.measured_at) > kMaxMarkerAge_s) {
    verdict = MarkerVerdict::kOutOfOrder;
  }
  if (verdict != MarkerVerdict::kQueued) {
    marker_counters_.Add(verdict);
  }
  return verdict;
}

void OpticalInertialFilter::ResetCovariance() {
  const OpticalInertialConfig& c = config_;
  P_.setZero();
  const auto set = [this](int first, int count, double sigma) {
    P_.diagonal().segment(first, count).setConstant(sigma * sigma);
  };
  set(kP, 3, c.sigma_start_p_m);
  set(kV, 3, c.sigma_start_v_m_s);
  set(kTheta, 2, c.sigma_start_tilt_rad);
  set(kTheta + 2, 1, c.sigma_start_heading_rad);
  set(kAccelBias, 3, c.sigma_start_accel_bias_m_s2);
  set(kGyroBias, 3, c.sigma_start_gyro_bias_rad_s);
  set(kLever, 3, c.estimate_lever_arm ? c.sigma_start_lever_m : 0.0);
  if (c.estimate_gravity) {
    set(kGravity, 2, c.sigma_start_gravity_tilt_rad * c.gravity_m_s2);
    set(kGravity + 2, 1, c.sigma_start_gravity_m_s2);
  }
  set(kTimeOffset, 1, c.estimate_time_offset ? c.sigma_start_marker_lead_s : 0.0);
  set(kGyroDelay, 1, c.estimate_gyro_delay ? c.sigma_start_gyro_delay_s : 0.0);
  set(kAccelMatrix, 9, c.estimate_calibration ? c.sigma_start_accel_matrix : 0.0);
  set(kGyroMatrix, 9, c.estimate_calibration ? c.sigma_start_gyro_matrix : 0.0);
  // A common turn of both matrices is a turn of the sensor's axes, which nothing can see. The axes
  // are those in which M_a is symmetric: M_a(i,j) = M_a(j,i) from the start.
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < i; ++j) {
      const int a = kAccelMatrix + 3 * j + i;
      const int b = kAccelMatrix + 3 * i + j;
      P_(a, b) = P_(b, a) = P_(a, a);
    }
  }
}

void OpticalInertialFilter::Start(Time at, const OpticalInertialState& state) {
  state_ = state;
  at_ = at;
  ResetCovariance();
  block_.Clear();
  block_noise_factor_ = 1.0;
  outliers_.Clear();
  started_ = true;
  chain_begins_ = true;
}

// @param navigation  of the sensor, r being what the configuration says.
void OpticalInertialFilter::StartFrom(Time at, const NavigationState& navigation,
                                      const Eigen::Vector3d& gyro_bias_rad_s) {
  OpticalInertialState state;
  state.navigation = navigation;
  state.errors.gyro_bias_rad_s = gyro_bias_rad_s;
  state.g_in_earth_m_s2 = {0.0, 0.0, -config_.gravity_m_s2};
  state.p_sensor_marker_m = {config_.lever_arm_x_m, config_.lever_arm_y_m, config_.lever_arm_z_m};
  state.marker_lead_s = config_.marker_lead_s;
  state.errors.gyro_delay_s = config_.gyro_delay_s;
  Start(at, state);
}

bool OpticalInertialFilter::LookForStart(Time at, const GatedInertial& inertial,
                                         const std::optional<Eigen::Quaterniond>& q_known) {
  const Time until = at + DurationFromSeconds(0.5 * inertial.dt_s);
  const auto marker = marker_gate_.Take(until, marker_counters_);
  if (q_known) {
    const auto known = known_start_.Add(inertial.reading, inertial.dt_s, *q_known, marker);
    if (known) {
      StartFrom(at, *known, Eigen::Vector3d::Zero());
    }
    return known.has_value();
  }
  const auto start = start_.Add(at, inertial, marker);
  if (start) {
    start_result_ = start;
    NavigationState navigation = start->navigation;  // of the marker's point
    navigation.p_earth_sensor_m -=
        navigation.q_earth_sensor *
        Eigen::Vector3d(config_.lever_arm_x_m, config_.lever_arm_y_m, config_.lever_arm_z_m);
    StartFrom(at, navigation, start->gyro_bias_rad_s);
  }
  return start.has_value();
}

OpticalStep OpticalInertialFilter::AddInertial(const sensing::MargSample& sample,
                                               const std::optional<Eigen::Quaterniond>& q_known) {
  OpticalStep step;
  const GatedInertial inertial = inertial_gate_.Pass(sample);
  step.verdict = inertial.verdict;
  inertial_counters_.Add(inertial.verdict);
  if (!inertial.usable()) {
    return step;
  }
  const Time at = sample.measured_at;
  if (started_ && inertial.long_dropout && inertial.dt_s > kMaxCrossed_s) {
    Restart();
  }
  if (!started_) {
    step.verdict = SampleVerdict::kStarting;
    if (LookForStart(at, inertial, q_known)) {
      step.restarted = true;
      last_ = inertial.reading;
      accel_E_ = state_.navigation.q_earth_sensor * state_.errors.Correct(last_).accel_m_s2 +
                 state_.g_in_earth_m_s2;
      epoch_.record = Record{};
      epoch_.record.into.top.setIdentity();
      FillEpoch();
      step.epoch_closed = true;
    }
    return step;
  }
  if (inertial.long_dropout) {
    CrossDropout(inertial.dt_s, at);
    last_ = inertial.reading;
    step.epoch_closed = true;
    return step;
  }
  if (inertial.dt_s > 0.0) {
    accel_E_ = AdvanceInertial(last_, inertial.reading, inertial.dt_s, state_.errors,
                               state_.g_in_earth_m_s2, state_.navigation, block_);
  }
  last_ = inertial.reading;
  at_ = at;
  block_noise_factor_ = std::max(block_noise_factor_, inertial.noise_factor);
  // A block ends where the next step would make it longer by more than it is short now.
  if (block_.dt_s > 0.0 && block_.dt_s >= config_.block_s - 0.5 * block_.dt_s / block_.steps) {
    CloseBlock(at);
    step.epoch_closed = started_;
  }
  return step;
}

void OpticalInertialFilter::CrossDropout(double dt_s, Time at) {
  // Nobody saw the motion: constant velocity and attitude, with what a limb can do in the time.
  state_.navigation.p_earth_sensor_m += dt_s * state_.navigation.v_earth_sensor_m_s;
  Transition F;
  F.top.setIdentity();
  const double D = dt_s + block_.dt_s;
  F.top.block<3, 3>(kP, kV) = D * Eigen::Matrix3d::Identity();
  PropagateCovariance(F, P_);
  const double var_v = Squared(kDropoutSpeedStd_m_s);
  AddProcessNoise({.var_v = var_v,
                   .cov_pv = 0.5 * D * var_v,
                   .var_p = D * D / 3.0 * var_v,
                   .var_theta = Squared(kDropoutRateStd_rad_s * D)},
                  kInertial, P_);
  at_ = at;
  block_.Clear();
  block_noise_factor_ = 1.0;
  epoch_.record.into = F;
  epoch_.record.measurement.fused = false;
  epoch_.had_marker = false;
  epoch_.degraded = true;
  FillEpoch();
}

void OpticalInertialFilter::DecayBiases(double dt_s) {
  state_.errors.accel_bias_m_s2 *= DecayOver(dt_s, noise_.tau_accel_bias_s);
  state_.errors.gyro_bias_rad_s *= DecayOver(dt_s, noise_.tau_gyro_bias_s);
}

void OpticalInertialFilter::CloseBlock(Time at) {
  Transition& F = epoch_.record.into;
  F.top.setZero();
  AddInertialTransition(block_, kInertial, 1.0, F.top);
  F.decay.setOnes();
  F.decay.segment<3>(kAccelBias - kMoving)
      .setConstant(DecayOver(block_.dt_s, noise_.tau_accel_bias_s));
  F.decay.segment<3>(kGyroBias - kMoving)
      .setConstant(DecayOver(block_.dt_s, noise_.tau_gyro_bias_s));
  PropagateCovariance(F, P_);
  const Eigen::Vector3d mean_accel_E =
      block_.sum_force_in_earth / block_.dt_s + state_.g_in_earth_m_s2;
  AddProcessNoise(ProcessNoiseOf(block_, noise_, mean_accel_E, Squared(block_noise_factor_)),
                  kInertial, P_);
  DecayBiases(block_.dt_s);
  epoch_.degraded = block_noise_factor_ > 1.0;

  epoch_.record.measurement.fused = false;
  epoch_.had_marker = false;
  const double step_s = block_.dt_s / block_.steps;
  if (const auto marker =
          marker_gate_.Take(at + DurationFromSeconds(0.5 * step_s), marker_counters_)) {
    FuseMarker(*marker);
  }
  block_.Clear();
  block_noise_factor_ = 1.0;
  if (started_ && GuardHealth()) {
    FillEpoch();
  }
}

void OpticalInertialFilter::FuseMarker(const TimedMarker& marker) {
  const double after_s = ToSeconds(marker.at - at_);
  if (-after_s > kMaxMarkerAge_s) {
    marker_counters_.Add(MarkerVerdict::kOutOfOrder);
    return;
  }
  const Eigen::Vector3d w_S = state_.errors.Correct(last_).gyro_rad_s;
  const MarkerPrediction predicted = PredictMarker(state_, w_S, accel_E_, after_s);
  const double late_m = std::abs(after_s * after_s * after_s) / 6.0 * kLateJerk_m_s3;
  const double variance =
      MarkerVariance(std::max(config_.sigma_marker_m, marker.sigma_m), config_.sigma_marker_time_s,
                     predicted.v_earth_marker_m_s) +
      late_m * late_m;
  Measurement& m = epoch_.record.measurement;
  m.H = predicted.H;
  m.nu = marker.p_earth_marker_m - predicted.p_earth_marker_m;
  if ((outliers_.in_doubt() || misfit_s_ > kMisfit_s) && !Recover(marker, m.nu)) {
    return;
  }
  const SoftGateConfig gate;
  const bool foreign = outliers_.foreign();
  const bool may_reject = foreign || outliers_.in_a_row() < gate.max_rejected_in_a_row;
  const UpdateReport report = SoftUpdate<kStates, kMarkerAxes>(
      gate, variance * Eigen::Matrix3d::Identity(), may_reject, P_, m);
  epoch_.nis = report.nis;
  // A filter that is wrong may see every marker downweighted and none rejected, and be dragged
  // about by them: time without agreement counts, and agreement pays it back.
  const double since_s = std::min(ToSeconds(marker.at - last_marker_at_), kMaxMisfitStep_s);
  last_marker_at_ = marker.at;
  misfit_s_ = report.outcome == GateOutcome::kFused
                  ? std::max(0.0, misfit_s_ - kAgreementPays * since_s)
                  : misfit_s_ + since_s;
  switch (report.outcome) {
    case GateOutcome::kRejected:
      outliers_.AddRejected(marker.at, m.nu);
      marker_counters_.Add(foreign ? MarkerVerdict::kForeign : MarkerVerdict::kOutlier);
      return;
    case GateOutcome::kDownweighted:
      if (report.nis > gate.reject_above_nis) {
        outliers_.AddDownweighted();
      } else {
        outliers_.Clear();
      }
      marker_counters_.Add(MarkerVerdict::kDownweighted);
      break;
    case GateOutcome::kFused:
      outliers_.Clear();
      marker_counters_.Add(MarkerVerdict::kFused);
      break;
  }
  epoch_.had_marker = true;
  Inject(m.K * m.nu, state_);
}

bool OpticalInertialFilter::Recover(const TimedMarker& marker, Eigen::Vector3d& nu) {
  // A second of disagreement (kMisfit_s): it is the filter that is wrong. Once: go to the marker
  // and be as unsure as at a start. Soon again: the attitude is lost as well.
  outliers_.Clear();
  misfit_s_ = 0.0;
  const bool again = doubted_ && ToSeconds(marker.at - doubted_at_) < kDoubtAgain_s;
  doubted_ = true;
  doubted_at_ = marker.at;
  if (again) {
    Restart();
    return false;
  }
  ResetCovariance();
  P_.diagonal().segment<3>(kV).setConstant(nu.squaredNorm() + Squared(kDropoutSpeedStd_m_s));
  state_.navigation.p_earth_sensor_m += nu;
  nu.setZero();
  chain_begins_ = true;
  return true;
}

void OpticalInertialFilter::Restart() {
  started_ = false;
  doubted_ = false;
  misfit_s_ = 0.0;
  outliers_.Clear();
  ++restarts_;
  start_ = OpticalStart(config_.gravity_m_s2);
  known_start_.Clear();
}

bool OpticalInertialFilter::GuardHealth() {
  const NavigationState& n = state_.navigation;
  const bool finite = n.p_earth_sensor_m.allFinite() && n.q_earth_sensor.coeffs().allFinite() &&
                      n.v_earth_sensor_m_s.squaredNorm() < kMaxSpeed_m_s * kMaxSpeed_m_s &&
                      P_.allFinite();
  if (!finite) {
    Restart();
    return false;
  }
  const auto diagonal = P_.diagonal();
  bool positive = true;
  for (int i = 0; i < kStates; ++i) {
    const bool fixed = i >= kLever && diagonal[i] == 0.0;
    positive = positive && (fixed || diagonal[i] > kMinVariance);
  }
  if (!positive) {
    const ErrorVector kept = diagonal.cwiseMax(0.0);
    ResetCovariance();
    // Rebuilt from the diagonal: what was known stays known, correlations are gone.
    for (int i = 0; i < kStates; ++i) {
      const double start = P_(i, i);
      P_(i, i) = kept[i] > kMinVariance ? std::min(kept[i], start) : start;
    }
    ++covariance_rebuilds_;
    epoch_.degraded = true;
    chain_begins_ = true;
  }
  return true;
}

void OpticalInertialFilter::FillEpoch() {
  epoch_.at = at_;
  epoch_.state = state_;
  epoch_.P = P_;
  epoch_.record.chain_begins = chain_begins_;
  chain_begins_ = false;
  const InertialReading corrected = state_.errors.Correct(last_);
  const Eigen::Matrix3d R_ES = state_.navigation.q_earth_sensor.toRotationMatrix();
  const Eigen::Vector3d force_E = R_ES * corrected.accel_m_s2;
  epoch_.accel_in_earth_m_s2 = force_E + state_.g_in_earth_m_s2;
  epoch_.w_earth_sensor_in_sensor_rad_s = corrected.gyro_rad_s;
  epoch_.accel_rows.setZero();
  epoch_.accel_rows.middleCols<3>(kTheta) = -math::Skew(force_E);
  epoch_.accel_rows.middleCols<3>(kAccelBias) = -R_ES;
  epoch_.accel_rows.middleCols<3>(kGravity).setIdentity();
  for (int j = 0; j < 3; ++j) {
    epoch_.accel_rows.middleCols<3>(kAccelMatrix + 3 * j) = -R_ES * last_.accel_m_s2[j];
  }
}

}  // namespace limbcast::filters
