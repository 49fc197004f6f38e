#include <algorithm>
#include <array>
#include <cmath>

#include "common/filters/position/coil_inertial_filter.hpp"
#include "common/filters/position/coil_motion_solver.hpp"
#include "common/math/rotation.hpp"

namespace limbcast::filters {
namespace {

// Notation: E earth, S sensor, M emitter. The beginning and the end of a track.

using Index = CoilInertialIndex;
constexpr int kSilentPulses = 3;
constexpr double kAgreesBelow = 9.0;  // NIS of a pulse's first sample; mean 3

// A pose that turns the source's up away from where its inertial unit has it is a wrong one,
// however well it fits: pulses at the end of their reach fit more than one.
bool KeepsUpright(const CoilPath& path, const CoilMotion& motion) {
  constexpr double kMost_rad = 0.35;
  const Eigen::Vector3d up_M = path.q_earth_emitter.conjugate() * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d up_E =
      path.q_earth_sensor.toRotationMatrix() * (motion.R_sensor_emitter * up_M);
  return up_E.z() > std::cos(kMost_rad);
}

}  // namespace

void CoilInertialFilter::Acquire(const sensing::CoilFrame& frame, CoilUpdateReport& report) {
  const bool pulsed = collector_.Update(frame, PathNow());
  if (at_rest_) {
    state_.v_earth_m_s.setZero();
  }
  if (!pulsed) {
    return;
  }
  auto burst = collector_.Burst();
  if (!burst) {
    return;
  }
  for (CoilObservation& o : *burst) {
    // At least what dead reckoning, settling and calibration leave.
    constexpr double kLeast = 0.01;
    o.sigma_tesla = std::hypot(
        o.sigma_tesla, std::max(kLeast, config_.relative_field_error) * o.field_tesla.norm());
  }
  CoilPoseConfig pose_config = config_.pose;
  const double sigma_v_m_s = at_rest_ ? config_.rest_sigma_v_m_s : config_.start_sigma_v_m_s;
  pose_config.var_velocity_m2_s2 = sigma_v_m_s * sigma_v_m_s;
  pose_config.max_sigma_m = config_.acquire_sigma_m;
  // Dead reckoning over half a second is not exact.
  pose_config.accept_cost *= 3.0;
  HemisphereRule rule;
  if (config_.half_space) {
    rule.half_space = config_.half_space;
    rule.boundary_rad = config_.half_space_boundary_rad;
  } else if (ever_tracked_) {
    // Dead reckoning says for a moment on which side the sensor is; then memory says it better.
    constexpr double kReckoned_s = 1.0;
    const CollectedPulse& middle = collector_.pulses()[1];
    const bool reckoned = ToSeconds(frame.measured_at - agreed_at_) < kReckoned_s;
    rule.predicted_emitter_m = reckoned
                                   ? middle.path.q_earth_emitter.conjugate() * middle.path.p_earth_m
                                   : agreed_emitter_m_;
  }
  if (ever_tracked_) {
    // The orientation runs on inertia; after three poses that do not fit anything may be.
    constexpr double kAboutKnown_rad = 0.09;
    constexpr int kPatience = 3;
    const CollectedPulse& middle = collector_.pulses()[1];
    CoilMotionPrior prior;
    prior.R_sensor_emitter =
        (middle.path.q_earth_sensor.conjugate() * middle.path.q_earth_emitter).toRotationMatrix();
    prior.sigma_rad = attempts_ < kPatience ? kAboutKnown_rad : 10.0 * kAboutKnown_rad;
    prior.sigma_v_m_s = sigma_v_m_s;
    const CoilMotion motion = SolveCoilMotion(pose_config, config_.source, *burst, rule, prior);
    ++attempts_;
    if (motion.accepted && KeepsUpright(middle.path, motion)) {
      Resume(frame, motion);
      report.acquired = true;
    } else if (attempts_ % kPatience == 0) {
      state_.v_earth_m_s.setZero();  // dead reckoning must not run away meanwhile
      collector_.Clear();
    }
    return;
  }
  const CoilPose pose = SolveCoilPose(pose_config, config_.source, *burst, rule);
  if (pose.verdict != CoilPoseVerdict::kAccepted) {
    state_.v_earth_m_s.setZero();
    return;
  }
  BeginTrack(frame, pose);
  report.acquired = true;
}

void CoilInertialFilter::BeginTrack(const sensing::CoilFrame& frame, const CoilPose& pose) {
  const CollectedPulse& middle = collector_.pulses()[1];
  const Eigen::Quaterniond q_EM_solved = middle.path.q_earth_sensor * pose.q_sensor_emitter;
  const Eigen::Matrix3d R_ES = middle.path.q_earth_sensor.toRotationMatrix();
  const Eigen::Matrix3d cov_theta_E = R_ES * pose.cov.bottomRightCorner<3, 3>() * R_ES.transpose();
  Eigen::Quaterniond q_EM =
      q_EM_solved * middle.path.q_earth_emitter.conjugate() * state_.q_earth_emitter;
  double sigma_tilt_rad = config_.start_sigma_tilt_rad;
  if (frame.emitter_inertial && at_rest_) {
    // The source's own accelerometer says better what is up.
    const Eigen::Vector3d up_E = q_EM * frame.emitter_accel_m_s2;
    q_EM = Eigen::Quaterniond::FromTwoVectors(up_E, Eigen::Vector3d::UnitZ()) * q_EM;
  } else {
    sigma_tilt_rad += std::sqrt(cov_theta_E.trace());
  }
  state_.q_earth_emitter = q_EM.normalized();
  SetVariance(P_, Index::kEmitterTheta,
              Eigen::Vector3d(sigma_tilt_rad, sigma_tilt_rad,
                              sigma_tilt_rad + std::sqrt(cov_theta_E(2, 2))));
  const Eigen::Matrix3d R_EM = q_EM_solved.toRotationMatrix();
  const double age_s = ToSeconds(frame.measured_at - middle.middle_at);
  state_.p_earth_m = R_EM * pose.p_emitter_sensor_m + (state_.p_earth_m - middle.path.p_earth_m);
  // δp = δp_noise + (J_v + age) δv, with the velocity that was taken for dp and for the time since.
  const double sigma_v_m_s = at_rest_ ? config_.rest_sigma_v_m_s : config_.start_sigma_v_m_s;
  const double var_v = sigma_v_m_s * sigma_v_m_s;
  Eigen::Matrix3d by_v = R_EM * pose.by_velocity.topRows<3>() * R_EM.transpose();
  const Eigen::Matrix3d cov_p =
      R_EM * pose.cov.topLeftCorner<3, 3>() * R_EM.transpose() - var_v * by_v * by_v.transpose();
  by_v.diagonal().array() += age_s;
  SetVariance(P_, Index::kP, 0.0);
  SetVariance(P_, Index::kV, sigma_v_m_s);
  P_.topLeftCorner<3, 3>() = cov_p + var_v * by_v * by_v.transpose();
  P_.block<3, 3>(Index::kP, Index::kV) = var_v * by_v;
  P_.block<3, 3>(Index::kV, Index::kP) = var_v * by_v.transpose();
  EnterTracking(frame);
}

void CoilInertialFilter::Resume(const sensing::CoilFrame& frame, const CoilMotion& motion) {
  const CollectedPulse& middle = collector_.pulses()[1];
  const Eigen::Matrix3d R_ES = middle.path.q_earth_sensor.toRotationMatrix();
  const Eigen::Matrix3d R_EM = R_ES * motion.R_sensor_emitter;
  const double age_s = ToSeconds(frame.measured_at - middle.middle_at);
  const Eigen::Vector3d dv_E = R_EM * motion.dv_emitter_m_s;
  const Eigen::Vector3d p_E = R_EM * motion.p_emitter_sensor_m;
  state_.p_earth_m = p_E + (state_.p_earth_m - middle.path.p_earth_m) + age_s * dv_E;
  state_.v_earth_m_s += dv_E;
  // R_EM of the middle of the burst, carried on as the gyro did.
  state_.q_earth_emitter = (math::QuaternionFromMatrix(R_EM) *
                            middle.path.q_earth_emitter.conjugate() * state_.q_earth_emitter)
                               .normalized();
  // With θ_m = θ_s + R_s θ_Ψ:  δp = R_m δp_M + θ_m × p + age δv,  δv = R_m δv_M.
  Eigen::Matrix<double, 9, 9> T = Eigen::Matrix<double, 9, 9>::Zero();  // rows p, v, θ_m
  T.block<3, 3>(0, 0) = R_EM;
  T.block<3, 3>(0, 3) = -math::Skew(p_E) * R_ES;
  T.block<3, 3>(0, 6) = age_s * R_EM;
  T.block<3, 3>(3, 6) = R_EM;
  T.block<3, 3>(6, 3) = R_ES;
  const Eigen::Matrix<double, 9, 9> own = T * motion.cov * T.transpose();
  Eigen::Matrix<double, 9, 3> U = Eigen::Matrix<double, 9, 3>::Zero();  // by θ_s
  U.topRows<3>() = -math::Skew(p_E);
  U.bottomRows<3>().setIdentity();
  const Eigen::Matrix3d P_ss = P_.block<3, 3>(Index::kSensorTheta, Index::kSensorTheta);
  const Eigen::Matrix<double, 9, 9> all = own + U * P_ss * U.transpose();
  const Eigen::Matrix<double, 9, 3> with_s = U * P_ss;
  const std::array<int, 3> blocks = {Index::kP, Index::kV, Index::kEmitterTheta};
  for (const int block : blocks) {
    SetVariance(P_, block, 0.0);
  }
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(3 * i);
    for (std::size_t j = 0; j < blocks.size(); ++j) {
      P_.block<3, 3>(blocks[i], blocks[j]) = all.block<3, 3>(row, static_cast<Eigen::Index>(3 * j));
    }
    P_.block<3, 3>(blocks[i], Index::kSensorTheta) = with_s.middleRows<3>(row);
    P_.block<3, 3>(Index::kSensorTheta, blocks[i]) = with_s.middleRows<3>(row).transpose();
  }
  EnterTracking(frame);
}

void CoilInertialFilter::EnterTracking(const sensing::CoilFrame& frame) {
  state_.background_earth_tesla =
      collector_.background_earth_tesla() - state_.gradient_earth_tesla_m * state_.p_earth_m;
  SetVariance(P_, Index::kBackground, config_.start_sigma_background_tesla);
  if (!ever_tracked_) {
    agreed_emitter_m_ = state_.p_emitter_sensor_m();
    agreed_at_ = frame.measured_at;
    background_start_tesla_ = state_.background_earth_tesla;
  }
  phase_ = CoilPhase::kTracking;
  attempts_ = 0;
  ever_tracked_ = true;
  at_rest_ = false;
  pulse_nis_ = 0.0;
  pulse_samples_ = pulses_seen_ = rejected_in_a_row_ = 0;
  silent_samples_ = silent_pulses_ = 0;
  silent_of_coil_.fill(0);
  gravity_at_ = background_at_ = window_begun_at_ = frame.measured_at;
  record_count_ = 1;
  records_[0].chain_begins = true;
  records_[0].measurement.fused = false;
}

// Pulses end by themselves. Tones go on: a window of them counts as a pulse.
bool CoilInertialFilter::IsPulseOver(const sensing::CoilFrame& frame) {
  if (frame.drive.coil != sensing::kAllCoils) {
    return frame.drive.coil < 0;
  }
  const bool over = ToSeconds(frame.measured_at - window_begun_at_) >= config_.tone_window_s;
  if (over) {
    window_begun_at_ = frame.measured_at;
  }
  return over;
}

void CoilInertialFilter::WatchPulses(const sensing::CoilFrame& frame, bool over,
                                     CoilUpdateReport& report) {
  if (over && (silent_samples_ > 0 || pulse_samples_ > 0)) {
    int& of_coil = silent_of_coil_[static_cast<std::size_t>(pulsed_coil_)];
    const bool silent = silent_samples_ > pulse_samples_;
    of_coil = silent ? of_coil + 1 : 0;
    silent_pulses_ = silent ? silent_pulses_ + 1 : 0;
    silent_samples_ = 0;
  }
  if (frame.drive.coil >= 0) {
    pulsed_coil_ = frame.drive.coil;
    silent_samples_ += report.coil_silent ? 1 : 0;
  }
  report.coil_alarm =
      *std::max_element(silent_of_coil_.begin(), silent_of_coil_.end()) >= kSilentPulses;
}

bool CoilInertialFilter::IsCertain() const {
  const double sigma_m = std::sqrt(P_.topLeftCorner<3, 3>().trace());
  return sigma_m <= config_.lost_relative_sigma * state_.p_earth_m.norm();
}

void CoilInertialFilter::WatchTrack(const sensing::CoilFrame& frame, CoilUpdateReport& report) {
  const bool over = IsPulseOver(frame);
  WatchPulses(frame, over, report);
  if (silent_pulses_ >= kSilentPulses) {
    Lose(report);  // the source is off, or the sensor is far from where it is taken to be
    return;
  }
  if (over && pulse_samples_ > 0) {
    pulse_means_[static_cast<std::size_t>(pulses_seen_ % 3)] = pulse_nis_ / pulse_samples_;
    ++pulses_seen_;
    const double first_nis =
        pulse_firsts_[static_cast<std::size_t>(pulses_seen_ - 1) % pulse_firsts_.size()];
    if (first_nis < kAgreesBelow && IsCertain()) {
      agreed_emitter_m_ = state_.p_emitter_sensor_m();
      agreed_at_ = frame.measured_at;
    }
    pulse_nis_ = 0.0;
    pulse_samples_ = 0;
    const double mean = (pulse_means_[0] + pulse_means_[1] + pulse_means_[2]) / 3.0;
    const double first =
        (pulse_firsts_[0] + pulse_firsts_[1] + pulse_firsts_[2] + pulse_firsts_[3]) / 4.0;
    if ((pulses_seen_ >= 3 && mean / 3.0 > config_.lost_nis) ||
        (pulses_seen_ >= 4 && first / 3.0 > config_.lost_first_nis)) {
      Lose(report);
      return;
    }
  }
  if (frame.drive.coil >= 0 && frame.drive.settled && report.nis > 0.0) {
    constexpr double kMost = 100.0;  // one outlier is no loss of track
    constexpr double kMostFirst = 60.0;
    if (pulse_samples_ == 0) {
      pulse_firsts_[static_cast<std::size_t>(pulses_seen_) % pulse_firsts_.size()] =
          std::min(report.nis, kMostFirst);
    }
    pulse_nis_ += std::min(report.nis, kMost);
    ++pulse_samples_;
  }
  const bool settled = pulses_seen_ >= 3;  // a new track is uncertain
  if ((settled && !IsCertain()) || state_.p_earth_m.norm() > config_.lost_range_m) {
    Lose(report);
  }
}

void CoilInertialFilter::Lose(CoilUpdateReport& report) {
  phase_ = CoilPhase::kAcquiring;
  collector_.Clear();
  record_count_ = 0;
  state_.v_earth_m_s.setZero();
  if (!(state_.p_earth_m.norm() <= config_.lost_range_m)) {
    state_.p_earth_m *= config_.pose.max_range_m / state_.p_earth_m.norm();
  }
  // What pulled the position away has pulled at all that hangs together with it. The calibration of
  // a sensor is the same before and after, and was learned over longer than the track went wrong.
  P_ = CoilCovariance(P_.diagonal().asDiagonal());
  SetVariance(P_, Index::kP, 0.0);
  SetVariance(P_, Index::kV, 0.0);
  const auto add = [this](int first, double sigma) {
    P_.diagonal().segment<3>(first).array() += sigma * sigma;
  };
  if (config_.estimate_gradient) {
    const double sigma = config_.start_sigma_gradient_tesla_m;
    P_.diagonal().segment<5>(Index::kGradient).array() += sigma * sigma;
  }
  add(Index::kSensorTheta, config_.start_sigma_tilt_rad);
  add(Index::kEmitterTheta, config_.start_sigma_tilt_rad);
  add(Index::kSensorAccelBias, config_.start_sigma_accel_bias_m_s2);
  add(Index::kSensorGyroBias, config_.start_sigma_gyro_bias_rad_s);
  if (last_ && last_->emitter_inertial) {
    add(Index::kEmitterAccelBias, config_.start_sigma_accel_bias_m_s2);
    add(Index::kEmitterGyroBias, config_.start_sigma_gyro_bias_rad_s);
  }
  report.lost = true;
  ++losses_;
}

}  // namespace limbcast::filters
