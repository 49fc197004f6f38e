#include "common/filters/position/coil_inertial_filter.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "common/filters/position/coil_measurement.hpp"
#include "common/math/rotation.hpp"

namespace limbcast::filters {
namespace {

// Notation: E earth, S sensor, M emitter.

using Index = CoilInertialIndex;
constexpr double kBackgroundStep_tesla = 5e-6;
constexpr double kLeastBackground_tesla = 20e-6;
constexpr double kMostBackground_tesla = 80e-6;
constexpr auto kDisturbedFor = std::chrono::seconds(1);
const Eigen::Vector3d kGravity_E(0.0, 0.0, -9.81);

InertialStates SensorStates() {
  InertialStates s;
  s.p = Index::kP;
  s.v = Index::kV;
  s.theta = Index::kSensorTheta;
  s.accel_bias = Index::kSensorAccelBias;
  s.gyro_bias = Index::kSensorGyroBias;
  s.accel_matrix = Index::kSensorAccelMatrix;
  s.gyro_matrix = Index::kSensorGyroMatrix;
  s.gyro_delay = Index::kSensorGyroDelay;
  return s;
}

InertialStates EmitterStates() {
  InertialStates s = SensorStates();
  s.theta = Index::kEmitterTheta;
  s.accel_bias = Index::kEmitterAccelBias;
  s.gyro_bias = Index::kEmitterGyroBias;
  s.accel_matrix = -1;
  s.gyro_matrix = -1;
  s.gyro_delay = -1;
  return s;
}

// The attitude, with any heading, in which `accel` points up.
Eigen::Quaterniond Levelled(const Eigen::Vector3d& accel_m_s2) {
  return Eigen::Quaterniond::FromTwoVectors(accel_m_s2, Eigen::Vector3d::UnitZ());
}

bool InertialFinite(const sensing::CoilFrame& frame) {
  return frame.gyro_rad_s.allFinite() && frame.accel_m_s2.allFinite() &&
         (!frame.emitter_inertial ||
          (frame.emitter_gyro_rad_s.allFinite() && frame.emitter_accel_m_s2.allFinite()));
}

}  // namespace

CoilInertialFilter::CoilInertialFilter(const CoilInertialConfig& config)
    : config_(config),
      collector_(config.sigma_mag_tesla, CoilPulseCollector::kBackgroundAfterLive,
                 config.tone_window_s) {}

Result<CoilInertialFilter> CoilInertialFilter::Make(const CoilInertialConfig& config) {
  if (const Status valid = Validate(config); !valid) {
    return valid.error();
  }
  return CoilInertialFilter(config);
}

CoilUpdateReport CoilInertialFilter::Update(const sensing::CoilFrame& given) {
  CoilUpdateReport report;
  record_count_ = 0;
  report.phase = phase_;
  if (last_ && given.measured_at <= last_->measured_at) {
    report.verdict = CoilFrameVerdict::kRejectedOutOfOrder;
    return report;
  }
  sensing::CoilFrame frame = given;
  if (IsCurrentWrong(frame.drive)) {
    frame.drive.settled = false;
  }
  double inflation = frame.inertial_saturated ? 30.0 * 30.0 : 1.0;
  const bool finite = InertialFinite(frame);
  if (!finite) {
    report.verdict = CoilFrameVerdict::kHeld;
    if (!last_) {
      return report;
    }
    frame.gyro_rad_s = last_->gyro_rad_s;
    frame.accel_m_s2 = last_->accel_m_s2;
    frame.emitter_gyro_rad_s = last_->emitter_gyro_rad_s;
    frame.emitter_accel_m_s2 = last_->emitter_accel_m_s2;
    inflation = 100.0;
  }
  if (phase_ == CoilPhase::kLevelling) {
    Level(frame);
    last_ = frame;
    report.phase = phase_;
    return report;
  }
  const double dt_s = ToSeconds(frame.measured_at - last_->measured_at);
  Propagate(frame, dt_s, dt_s > 0.02 ? std::max(inflation, 100.0) : inflation);
  if (dt_s > config_.longest_hold_s) {
    P_.diagonal().segment<3>(Index::kV).array() += 1.0;
  }
  last_ = frame;
  if (std::max(frame.gyro_rad_s.norm(), frame.emitter_inertial ? frame.emitter_gyro_rad_s.norm()
                                                               : 0.0) > config_.rest_below_rad_s) {
    at_rest_ = false;
  }
  if (!state_.IsFinite() || !P_.allFinite()) {
    *this = CoilInertialFilter(config_);
    report.lost = true;
    report.phase = phase_;
    return report;
  }
  GuardCovariance(report);
  if (phase_ == CoilPhase::kAcquiring) {
    Acquire(frame, report);
  } else {
    UseSample(frame, report);
    UseEmitterSample(frame);
    UseGauges(frame);
    WatchTrack(frame, report);
  }
  report.phase = phase_;
  report.disturbed = frame.measured_at < disturbed_until_;
  return report;
}

void CoilInertialFilter::Level(const sensing::CoilFrame& frame) {
  if (!last_) {
    begun_at_ = frame.measured_at;
  }
  const bool patient = ToSeconds(frame.measured_at - begun_at_) < config_.rest_patience_s;
  const double rate_rad_s = std::max(
      frame.gyro_rad_s.norm(), frame.emitter_inertial ? frame.emitter_gyro_rad_s.norm() : 0.0);
  if (sums_.count == 0 || (patient && rate_rad_s > config_.rest_below_rad_s)) {
    sums_ = {};
    rest_since_ = frame.measured_at;
  }
  sums_.accel += frame.accel_m_s2;
  sums_.gyro += frame.gyro_rad_s;
  sums_.emitter_accel += frame.emitter_accel_m_s2;
  sums_.emitter_gyro += frame.emitter_gyro_rad_s;
  ++sums_.count;
  // Tones go on while nothing moves; their mean is small.
  if ((frame.drive.coil < 0 || frame.drive.coil == sensing::kAllCoils) && frame.HasField()) {
    sums_.mag += frame.mag_tesla;
    ++sums_.mag_count;
  }
  if (ToSeconds(frame.measured_at - rest_since_) < config_.rest_s || sums_.mag_count < 3) {
    return;
  }
  const double n = sums_.count;
  state_ = {};
  state_.q_earth_sensor = Levelled(sums_.accel);
  const Eigen::Vector3d mag_E = state_.q_earth_sensor * (sums_.mag / sums_.mag_count);
  const double north_rad = std::atan2(mag_E.x(), mag_E.y());  // turns the field to +y
  state_.q_earth_sensor =
      Eigen::AngleAxisd(north_rad, Eigen::Vector3d::UnitZ()) * state_.q_earth_sensor;
  state_.q_earth_emitter =
      frame.emitter_inertial ? Levelled(sums_.emitter_accel) : Eigen::Quaterniond::Identity();
  if (patient) {
    state_.sensor.gyro_bias_rad_s = sums_.gyro / n;
    if (frame.emitter_inertial) {
      state_.emitter.gyro_bias_rad_s = sums_.emitter_gyro / n;
    }
    for (Eigen::Vector3d* bias :
         {&state_.sensor.gyro_bias_rad_s, &state_.emitter.gyro_bias_rad_s}) {
      *bias *= std::min(1.0, 2.0 * config_.start_sigma_gyro_bias_rad_s / (bias->norm() + 1e-12));
    }
  }
  state_.background_earth_tesla = state_.q_earth_sensor * (sums_.mag / sums_.mag_count);
  background_start_tesla_ = state_.background_earth_tesla;
  const double tilt = config_.start_sigma_tilt_rad * (patient ? 1.0 : 4.0);
  P_.setZero();
  SetVariance(P_, Index::kSensorTheta, tilt);
  SetVariance(P_, Index::kEmitterTheta, tilt);
  for (const int accel_bias : {Index::kSensorAccelBias, Index::kEmitterAccelBias}) {
    SetVariance(P_, accel_bias, config_.start_sigma_accel_bias_m_s2);
  }
  for (const int gyro_bias : {Index::kSensorGyroBias, Index::kEmitterGyroBias}) {
    SetVariance(P_, gyro_bias, config_.start_sigma_gyro_bias_rad_s);
  }
  if (!frame.emitter_inertial) {
    SetVariance(P_, Index::kEmitterAccelBias, 0.0);
    SetVariance(P_, Index::kEmitterGyroBias, 0.0);
  }
  SetVariance(P_, Index::kBackground, config_.start_sigma_background_tesla);
  if (config_.estimate_gradient) {
    const double sigma = config_.start_sigma_gradient_tesla_m;
    P_.diagonal().segment<5>(Index::kGradient).setConstant(sigma * sigma);
    SetVariance(P_, Index::kEmitterMagOffset, config_.start_sigma_emitter_mag_offset_tesla);
  }
  if (config_.estimate_calibration) {
    SetMatrixVariance(P_, Index::kSensorAccelMatrix, config_.start_sigma_accel_matrix);
    SetMatrixVariance(P_, Index::kSensorGyroMatrix, config_.start_sigma_gyro_matrix);
  }
  if (config_.estimate_gyro_delay) {
    P_(Index::kSensorGyroDelay, Index::kSensorGyroDelay) =
        config_.start_sigma_gyro_delay_s * config_.start_sigma_gyro_delay_s;
  }
  at_rest_ = patient;
  phase_ = CoilPhase::kAcquiring;
  collector_.Clear();
}

void CoilInertialFilter::Propagate(const sensing::CoilFrame& frame, double dt_s, double inflation) {
  CoilRecord& record = records_[0];
  record_count_ = phase_ == CoilPhase::kTracking ? 1 : 0;
  record.chain_begins = false;
  record.stays = false;
  record.measurement.fused = false;
  record.into = {};
  record.into.decay.setOnes();
  sensor_block_.Clear();
  NavigationState sensor;
  sensor.q_earth_sensor = state_.q_earth_sensor;
  AdvanceInertial({last_->gyro_rad_s, last_->accel_m_s2}, {frame.gyro_rad_s, frame.accel_m_s2},
                  dt_s, state_.sensor, kGravity_E, sensor, sensor_block_);
  Eigen::Vector3d dp = sensor.p_earth_sensor_m;
  Eigen::Vector3d dv = sensor.v_earth_sensor_m_s;
  const Eigen::Vector3d a_sensor_E = dv / dt_s;
  state_.q_earth_sensor = sensor.q_earth_sensor;
  AddInertialTransition(sensor_block_, SensorStates(), 1.0, record.into.top);
  Eigen::Vector3d a_emitter_E = Eigen::Vector3d::Zero();
  if (frame.emitter_inertial) {
    emitter_block_.Clear();
    NavigationState emitter;
    emitter.q_earth_sensor = state_.q_earth_emitter;
    AdvanceInertial({last_->emitter_gyro_rad_s, last_->emitter_accel_m_s2},
                    {frame.emitter_gyro_rad_s, frame.emitter_accel_m_s2}, dt_s, state_.emitter,
                    kGravity_E, emitter, emitter_block_);
    dp -= emitter.p_earth_sensor_m;
    dv -= emitter.v_earth_sensor_m_s;
    a_emitter_E = emitter.v_earth_sensor_m_s / dt_s;
    state_.q_earth_emitter = emitter.q_earth_sensor;
    AddInertialTransition(emitter_block_, EmitterStates(), -1.0, record.into.top);
  }
  state_.p_earth_m += dt_s * state_.v_earth_m_s + dp;
  state_.v_earth_m_s += dv;

  PropagateCovariance(record.into, P_);
  AddProcessNoise(ProcessNoiseOf(sensor_block_, config_.inertial, a_sensor_E, inflation),
                  SensorStates(), P_);
  if (frame.emitter_inertial) {
    AddProcessNoise(ProcessNoiseOf(emitter_block_, config_.inertial, a_emitter_E, inflation),
                    EmitterStates(), P_);
  }
  double walk = config_.walk_background_tesla_rts * Unrest();
  if (frame.measured_at < disturbed_until_) {
    walk *= 10.0;
  }
  if (config_.estimate_gradient) {
    const double walk_gradient = config_.walk_gradient_per_m * walk;
    P_.diagonal().segment<5>(Index::kGradient).array() += walk_gradient * walk_gradient * dt_s;
    walk *= config_.walk_beside_gradient;
    const double of_radian = config_.mag_calibration_error * state_.background_earth_tesla.norm();
    P_.diagonal().segment<3>(Index::kBackground).array() +=
        of_radian * of_radian * frame.gyro_rad_s.norm() * dt_s;
  }
  P_.diagonal().segment<3>(Index::kBackground).array() += walk * walk * dt_s;
}

// How many times faster the background walks than was said: where its samples are a surprise again
// and again, the room changes faster. NIS/3 of 1 is none; the walk grows until there is little
// left.
double CoilInertialFilter::Unrest() const {
  constexpr double kUsual = 2.0;  // chance, over ten samples
  constexpr double kMost = 300.0;
  const double above = std::max(1.0, background_nis_ / kUsual);
  return std::min(kMost, above * above);
}

void CoilInertialFilter::WatchBackground(double nis) {
  constexpr double kShare = 0.1;    // of a new sample in the mean
  constexpr double kMost = 1000.0;  // one outlier is no room
  if (!heeds_surprise_) {
    return;
  }
  background_nis_ += kShare * (std::min(nis, kMost) / 3.0 - background_nis_);
}

void CoilInertialFilter::UseSample(const sensing::CoilFrame& frame, CoilUpdateReport& report) {
  if (!frame.HasField()) {
    if (report.verdict == CoilFrameVerdict::kUsed) {
      report.verdict = CoilFrameVerdict::kInertialOnly;
    }
    return;
  }
  // Iterated: linearise, solve from the prediction, linearise where that led.
  auto& record = records_[0].measurement;
  const CoilInertialState before = state_;
  CoilVector step = CoilVector::Zero();
  Eigen::Matrix3d R_noise;
  const double limit_m = config_.max_step * before.p_earth_m.norm();
  const int iterations = frame.drive.coil >= 0 ? config_.iterations : 1;
  for (int i = 0; i < iterations; ++i) {
    const CoilPrediction h = PredictCoilSample(config_.source, frame.drive, Plus(before, step));
    record.H = h.H;
    record.nu = frame.mag_tesla - h.field_tesla + h.H * step;
    const double relative = config_.relative_field_error * h.coil_tesla;
    R_noise = (config_.sigma_mag_tesla * config_.sigma_mag_tesla + relative * relative) *
              Eigen::Matrix3d::Identity();
    if (i + 1 == iterations) {
      break;
    }
    const Eigen::Matrix<double, Index::kAll, 3> PHt = P_ * record.H.transpose();
    const Eigen::Matrix3d S = record.H * PHt + R_noise;
    const Eigen::Vector3d weighted = S.llt().solve(record.nu);
    const double nis = record.nu.dot(weighted);
    if (i == 0 && nis > config_.gate.downweight_above_nis && frame.drive.coil >= 0 &&
        h.coil_tesla > 6.0 * config_.sigma_mag_tesla && FitsWithoutCoil(frame)) {
      report.coil_silent = true;
      report.verdict = CoilFrameVerdict::kInertialOnly;
      return;
    }
    step = PHt * weighted / std::max(1.0, nis / config_.gate.downweight_above_nis);
    const double moved_m = step.segment<3>(Index::kP).norm();
    if (moved_m > limit_m) {
      step *= limit_m / moved_m;
    }
  }
  const UpdateReport update = SoftUpdate(
      config_.gate, R_noise, rejected_in_a_row_ < config_.gate.max_rejected_in_a_row, P_, record);
  report.gate = update.outcome;
  report.nis = update.nis;
  if (frame.drive.coil < 0) {
    WatchBackground(update.nis);
  }
  rejected_in_a_row_ = update.outcome == GateOutcome::kRejected ? rejected_in_a_row_ + 1 : 0;
  if (record.fused) {
    step = record.K * record.nu;
    const double moved_m = step.segment<3>(Index::kP).norm();
    if (moved_m > limit_m) {
      step *= limit_m / moved_m;
    }
    state_ = Plus(before, step);
  } else if (report.verdict == CoilFrameVerdict::kUsed) {
    report.verdict = CoilFrameVerdict::kInertialOnly;
  }
  const double background_tesla = state_.background_earth_tesla.norm();
  const bool stepped = frame.drive.coil < 0 && record.nu.norm() > kBackgroundStep_tesla;
  if (background_tesla < kLeastBackground_tesla || background_tesla > kMostBackground_tesla ||
      stepped) {
    disturbed_until_ = frame.measured_at + kDisturbedFor;
  }
}

// The field without any coil explains the reading, which the field with it does not.
bool CoilInertialFilter::FitsWithoutCoil(const sensing::CoilFrame& frame) const {
  const CoilPrediction h = PredictCoilSample(config_.source, {}, state_);
  const Eigen::Vector3d nu = frame.mag_tesla - h.field_tesla;
  Eigen::Matrix3d S = h.H * P_ * h.H.transpose();
  S.diagonal().array() += config_.sigma_mag_tesla * config_.sigma_mag_tesla;
  return nu.dot(S.llt().solve(nu)) <= config_.gate.downweight_above_nis;
}

UpdateReport CoilInertialFilter::Correct(const SoftGateConfig& gate,
                                         const Eigen::Matrix<double, 6, 6>& R_noise,
                                         CoilPoseRecord& record) {
  const UpdateReport report = SoftUpdate(gate, R_noise, true, P_, record);
  if (record.fused) {
    state_ = Plus(state_, record.K * record.nu);
  }
  return report;
}

void CoilInertialFilter::GuardCovariance(CoilUpdateReport& report) {
  const auto variances = P_.diagonal();
  if ((variances.array() >= 0.0).all()) {
    return;
  }
  // What is left of it says how large the errors are, and not how they hang together.
  P_ = CoilCovariance(variances.cwiseAbs().asDiagonal());
  report.rebuilt = true;
  ++rebuilds_;
  record_count_ = 0;
  if (phase_ == CoilPhase::kTracking) {
    record_count_ = 1;
    records_[0].chain_begins = true;
  }
}

}  // namespace limbcast::filters
