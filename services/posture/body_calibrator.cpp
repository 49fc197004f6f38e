#include "services/posture/body_calibrator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "common/math/angles.hpp"
#include "common/units/units.hpp"

namespace limbcast::posture {
namespace {

constexpr double kMinWalk_s = 6.0;
constexpr double kStillWindow_s = 1.0;
/// People who stand sway, and let their arms hang: this much within the window.
constexpr double kStillLimit_rad = 0.1;
constexpr std::size_t kMaxStills = 64;
constexpr Duration kLookEvery = std::chrono::milliseconds(250);
constexpr Duration kTryEvery = std::chrono::seconds(1);
/// Two looks belong to one still moment.
constexpr Duration kSameMoment = std::chrono::milliseconds(600);
/// How trunk and legs may be inclined otherwise than while walking in an automatic stance.
constexpr double kAutomaticTilt_rad = 0.35;
/// How much of the window the person has to walk.
constexpr double kAutomaticLeast = 0.9;

}  // namespace

void BodyCalibrator::Add(body::Segment segment, Time measured_at,
                         const Eigen::Quaterniond& q_earth_sensor,
                         const Eigen::Vector3f& free_accel_in_earth_m_s2) {
  log_.Add(segment, measured_at, q_earth_sensor, free_accel_in_earth_m_s2);
}

void BodyCalibrator::NoteStance(const body::StandingPose& pose, Time at) {
  stance_ = pose;
  started_at_.reset();
  looked_at_ = at;
}

Status BodyCalibrator::Start(Time at) {
  if (!stance_) {
    return Error{ErrorCode::kInvalidArgument, "take a reference pose first"};
  }
  started_at_ = at;
  return Ok();
}

Result<CalibrationOutcome> BodyCalibrator::Fit(const body::StandingPose& stance,
                                               body::MotionRecord walking, SegmentSet tracked,
                                               double facing_rad, bool common_heading) const {
  CalibrationOutcome outcome;
  std::erase_if(walking.segments, [&](const body::SegmentRecord& motion) {
    return !stance.known[body::Index(motion.segment)];
  });
  for (const body::Segment segment : body::AllSegments()) {
    const bool there = std::any_of(walking.segments.begin(), walking.segments.end(),
                                   [&](const auto& motion) { return motion.segment == segment; });
    if ((tracked & BitOf(segment)) != 0 && !there) {
      outcome.left_out.push_back(segment);
    }
  }
  auto fit = body::FitFunctionalAlignment({.standing = stance,
                                           .walking = std::move(walking),
                                           .facing_rad = facing_rad,
                                           .common_heading = common_heading});
  if (!fit) {
    return fit.error();
  }
  outcome.fit = std::move(*fit);
  return outcome;
}

Result<CalibrationOutcome> BodyCalibrator::Finish(SegmentSet tracked, double facing_rad,
                                                  bool common_heading) {
  const auto newest = log_.newest();
  if (!stance_ || !started_at_ || !newest) {
    return Error{ErrorCode::kInvalidArgument, "no functional calibration was started"};
  }
  const double walked_s = ToSeconds(*newest - *started_at_);
  if (walked_s < kMinWalk_s) {
    return Error{
        ErrorCode::kInvalidArgument,
        fmt::format("walked {:.1f} s, needs at least {:.0f} s: go on", walked_s, kMinWalk_s)};
  }
  auto outcome =
      Fit(*stance_, log_.Extract(tracked, *newest, walked_s), tracked, facing_rad, common_heading);
  started_at_.reset();
  return outcome;
}

void BodyCalibrator::LookForStillness(SegmentSet tracked) {
  const auto newest = log_.newest();
  if (!newest || *newest - looked_at_ < kLookEvery) {
    return;
  }
  looked_at_ = *newest;
  still_now_.reset();
  const body::MotionRecord record = log_.Extract(tracked, *newest, kStillWindow_s);
  Still still{.pose = {}, .at = *newest, .spread_rad = 0.0};
  SegmentSet heard = 0;
  for (const body::SegmentRecord& motion : record.segments) {
    const body::OrientationAverage average = body::Average(motion.q_earth_sensor);
    still.pose.known[body::Index(motion.segment)] = true;
    still.pose.q_earth_sensor[body::Index(motion.segment)] = average.mean;
    still.spread_rad = std::max(still.spread_rad, average.spread_rad);
    heard |= BitOf(motion.segment);
  }
  if (heard != tracked || heard == 0 || still.spread_rad > kStillLimit_rad) {
    return;
  }
  still_now_ = still.pose;
  if (!stills_.empty() && still.at - stills_.back().at < kSameMoment) {
    // The calmest second of a still moment stands for it; its end is what the next look joins.
    Still& moment = stills_.back();
    moment.at = still.at;
    if (still.spread_rad < moment.spread_rad) {
      moment = still;
    }
    return;
  }
  if (stills_.size() == kMaxStills) {
    stills_.erase(stills_.begin() + 1);  // the first is the likeliest stance
  }
  stills_.push_back(still);
}

std::optional<CalibrationOutcome> BodyCalibrator::Automatic(SegmentSet tracked,
                                                            bool common_heading) {
  LookForStillness(tracked);
  const auto newest = log_.newest();
  if (!newest || stills_.empty() || still_now_ || *newest - tried_at_ < kTryEvery) {
    return std::nullopt;
  }
  tried_at_ = *newest;
  body::MotionRecord walking = log_.Extract(tracked, *newest, kAutomaticWalk_s);
  const auto stance = std::find_if(stills_.begin(), stills_.end(), [&](const Still& still) {
    return body::StanceTilt_rad(still.pose, walking) < kAutomaticTilt_rad;
  });
  if (walking.segments.empty() || stance == stills_.end()) {
    return std::nullopt;
  }
  auto outcome = Fit(stance->pose, std::move(walking), tracked, 0.0, common_heading);
  if (!outcome || !outcome->left_out.empty() ||
      outcome->fit.walked_s < kAutomaticLeast * kAutomaticWalk_s ||
      std::any_of(outcome->fit.segments.begin(), outcome->fit.segments.end(),
                  [](const auto& segment) { return !segment.doubt.empty(); })) {
    return std::nullopt;
  }
  return std::move(*outcome);
}

std::vector<BodyCalibrator::HeadingError> BodyCalibrator::SurveyArms(
    SegmentSet tracked, const body::PerSegment<double>& heading_correction_rad) const {
  SegmentSet wanted = 0;
  for (const body::Segment segment : body::AllSegments()) {
    // The trunk's directions steady the root; legs would cost time and add little.
    const bool needed = body::IsArm(segment) || body::IsTrunk(segment);
    wanted |= needed ? BitOf(segment) & tracked : 0;
  }
  std::vector<HeadingError> errors;
  const auto newest = log_.newest();
  const auto seen = newest ? body::FindWalkingDirections(log_.Extract(wanted, *newest, kSurvey_s))
                           : Error{ErrorCode::kNotFound, "nothing heard"};
  if (!seen || !body::IsTrunk(seen->front().segment)) {
    return errors;
  }
  const auto common_rad = [&](const body::WalkingDirection& one) {
    return one.direction_rad + heading_correction_rad[body::Index(one.segment)];
  };
  math::AngleMean trunk;
  for (const body::WalkingDirection& one : *seen) {
    if (body::IsTrunk(one.segment) && one.segment != body::Segment::kHead) {
      trunk.Add(common_rad(one));
    }
  }
  for (const body::WalkingDirection& one : *seen) {
    if (body::IsArm(one.segment)) {
      errors.push_back({one.segment, common_rad(one) - trunk.Mean_rad(), one.sigma_rad});
    }
  }
  return errors;
}

void BodyCalibrator::Clear() { *this = BodyCalibrator{}; }

std::string ApplyFit(const CalibrationOutcome& outcome, body::BodyDefinition& definition) {
  std::size_t aligned = 0;
  double sigma_rad = 0.0;
  std::string doubts;
  for (const body::SegmentFit& fit : outcome.fit.segments) {
    body::SegmentDefinition* const segment = body::Find(definition, fit.segment);
    if (segment == nullptr) {
      continue;
    }
    if (!fit.doubt.empty()) {
      doubts += fmt::format("; {}: {}", body::ToString(fit.segment), fit.doubt);
      continue;
    }
    segment->q_sensor_segment = fit.q_sensor_segment;
    segment->heading_correction_rad = fit.heading_correction_rad;
    segment->aligned = true;
    segment->alignment_quality =
        static_cast<float>(std::clamp(1.0 - fit.sigma_rad / body::kMaxFitSigma_rad, 0.0, 1.0));
    sigma_rad = std::max(sigma_rad, fit.sigma_rad);
    ++aligned;
  }
  for (const body::Segment segment : outcome.left_out) {
    doubts += fmt::format("; {}: not heard all the time", body::ToString(segment));
  }
  return fmt::format(
      "aligned {} segments from {:.0f} strides of {:.2f} s, headings within {:.0f} "
      "deg{}",
      aligned, outcome.fit.strides, outcome.fit.stride_s, units::DegFromRad(sigma_rad), doubts);
}

}  // namespace limbcast::posture
