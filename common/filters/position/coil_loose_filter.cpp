#include "common/filters/position/coil_loose_filter.hpp"

#include <algorithm>
#include <cmath>

#include "common/filters/position/coil_measurement.hpp"

namespace limbcast::filters {
namespace {

using Index = CoilInertialIndex;
constexpr int kMostRefused = 3;
constexpr double kPoseValues = 6.0;
// Chance exceeds 16 of three values and 22.5 of six as often: once in a thousand.
constexpr double kSixForThree = 22.5 / 16.0;

bool IsPulse(const sensing::CoilFrame& frame) { return frame.drive.coil >= 0 && frame.HasField(); }

// The frame with its magnetometer sample kept from CoilInertialFilter if a coil was on.
sensing::CoilFrame WithoutPulse(sensing::CoilFrame frame) {
  if (frame.drive.coil >= 0) {
    frame.drive = {.settled = false};
  }
  return frame;
}

}  // namespace

LooseCoilFilter::LooseCoilFilter(const CoilInertialConfig& config, const CoilInertialFilter& filter)
    : config_(config),
      now_(filter),
      anchor_(filter),
      frames_(kFrames),
      collector_(config.sigma_mag_tesla, CoilPulseCollector::kBackgroundAfterLive) {}

Result<LooseCoilFilter> LooseCoilFilter::Make(const CoilInertialConfig& given) {
  CoilInertialConfig config = given;
  config.estimate_calibration = false;
  config.estimate_gyro_delay = false;
  config.estimate_gradient = false;
  const auto filter = CoilInertialFilter::Make(config);
  if (!filter) {
    return filter.error();
  }
  if (!config.half_space) {
    return Error{ErrorCode::kInvalidArgument, "loose coil filter: half_space must be given"};
  }
  return LooseCoilFilter(config, *filter);
}

CoilUpdateReport LooseCoilFilter::Update(const sensing::CoilFrame& given) {
  sensing::CoilFrame frame = given;
  if (IsCurrentWrong(frame.drive)) {
    frame.drive.settled = false;
  }
  if (phase() != CoilPhase::kTracking) {
    const CoilUpdateReport report = now_.Update(frame);
    if (report.acquired) {
      BeginTrack(frame.measured_at);
    }
    return report;
  }
  const sensing::CoilFrame inertial = WithoutPulse(frame);
  CoilUpdateReport report = now_.Update(inertial);
  if (report.verdict == CoilFrameVerdict::kRejectedOutOfOrder) {
    return report;
  }
  if (report.verdict == CoilFrameVerdict::kInertialOnly && IsPulse(frame)) {
    report.verdict = CoilFrameVerdict::kUsed;  // for the pose to come
  }
  report.gate = GateOutcome::kFused;
  report.nis = 0.0;
  if (phase() == CoilPhase::kTracking) {
    Keep(inertial);
    if (collector_.Update(frame,
                          {state().q_earth_sensor, state().q_earth_emitter, state().p_earth_m})) {
      UseBurst(report);
    }
    if (phase() == CoilPhase::kTracking && IsLost()) {
      now_.LoseTrack();
    }
  }
  if (phase() != CoilPhase::kTracking) {
    report.lost = true;
    ++losses_;
  }
  report.phase = phase();
  return report;
}

void LooseCoilFilter::BeginTrack(Time at) {
  anchor_ = now_;
  anchor_at_ = at;
  frame_count_ = 0;
  collector_.Clear();
  poses_ = refused_in_a_row_ = 0;
}

void LooseCoilFilter::Keep(const sensing::CoilFrame& frame) {
  if (frame_count_ == kFrames) {
    AdvanceAnchor(frames_[kFrames / 2].measured_at);
  }
  frames_[frame_count_++] = frame;
}

void LooseCoilFilter::AdvanceAnchor(Time until) {
  std::size_t passed = 0;
  while (passed < frame_count_ && frames_[passed].measured_at <= until) {
    anchor_.Update(frames_[passed]);
    anchor_at_ = frames_[passed].measured_at;
    ++passed;
  }
  std::move(frames_.begin() + static_cast<std::ptrdiff_t>(passed),
            frames_.begin() + static_cast<std::ptrdiff_t>(frame_count_), frames_.begin());
  frame_count_ -= passed;
}

void LooseCoilFilter::UseBurst(CoilUpdateReport& report) {
  const auto burst = collector_.Burst();
  if (!burst) {
    return;
  }
  const Time middle_at = collector_.pulses()[1].middle_at;
  // The attitude is about to jump: samples turned by the old one and by the new do not mix.
  collector_.Clear();
  if (middle_at < anchor_at_) {
    return;
  }
  AdvanceAnchor(middle_at);
  const CoilMotion pose = SolveAtAnchor(*burst);
  if (!pose.accepted) {
    ++refused_in_a_row_;
    return;
  }
  CoilPoseRecord record;
  PoseOfBurst(anchor_.state(), pose.p_emitter_sensor_m, pose.R_sensor_emitter, record);
  SoftGateConfig gate = config_.gate;
  gate.downweight_above_nis *= kSixForThree;
  const UpdateReport update = anchor_.Correct(gate, pose.cov.topLeftCorner<6, 6>(), record);
  report.gate = update.outcome;
  report.nis = update.nis;
  if (!record.fused) {
    ++refused_in_a_row_;
    return;
  }
  constexpr double kMost = 100.0;  // one outlier is no loss of track
  refused_in_a_row_ = 0;
  nis_[static_cast<std::size_t>(poses_++) % nis_.size()] = std::min(update.nis, kMost);
  now_ = anchor_;
  for (std::size_t k = 0; k < frame_count_; ++k) {
    now_.Update(frames_[k]);
  }
}

CoilMotion LooseCoilFilter::SolveAtAnchor(std::array<CoilObservation, 3> burst) const {
  for (CoilObservation& o : burst) {
    o.sigma_tesla = std::hypot(o.sigma_tesla, config_.relative_field_error * o.field_tesla.norm());
  }
  const CoilInertialState& state = anchor_.state();
  HemisphereRule rule;
  rule.predicted_emitter_m = state.p_emitter_sensor_m();
  CoilMotionPrior prior;
  prior.R_sensor_emitter = state.q_sensor_emitter().toRotationMatrix();
  prior.sigma_rad = 10.0;  // nothing: the pose is of the pulses alone
  prior.sigma_v_m_s =
      std::sqrt(anchor_.covariance().block<3, 3>(Index::kV, Index::kV).trace() / 3.0);
  CoilPoseConfig pose_config = config_.pose;
  // As for a new track: a poor pose is better than none. With the 0.1 m of section 8 a bench at
  // 0.75 m and a walking leg get lost.
  pose_config.max_sigma_m = config_.acquire_sigma_m;
  return SolveCoilMotion(pose_config, config_.source, burst, rule, prior);
}

bool LooseCoilFilter::IsLost() const {
  if (refused_in_a_row_ >= kMostRefused) {
    return true;
  }
  if (poses_ < static_cast<int>(nis_.size())) {
    return false;  // a new track is uncertain
  }
  const double mean_nis = (nis_[0] + nis_[1] + nis_[2]) / 3.0;
  const double sigma_m = std::sqrt(covariance().topLeftCorner<3, 3>().trace());
  return mean_nis / kPoseValues > config_.lost_nis ||
         !(sigma_m <= config_.lost_relative_sigma * state().p_earth_m.norm());
}

void LooseCoilFilter::Disturb(const CoilVector& error) {
  anchor_.Disturb(error);
  now_.Disturb(error);
}

}  // namespace limbcast::filters
