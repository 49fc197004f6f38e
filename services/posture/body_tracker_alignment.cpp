// The part of BodyTracker that changes alignment while states pass by: smooth transitions, headings
// that are kept together, calibration without a command.
#include <algorithm>
#include <cmath>
#include <utility>

#include "common/body/alignment.hpp"
#include "common/math/rotation.hpp"
#include "services/posture/body_tracker.hpp"

namespace limbcast::posture {
namespace {

/// Turned by more than this, a heading goes into the definition for clients to see.
constexpr double kFoldBeyond_rad = 0.035;  // 2°
/// Below this a new alignment is the old one.
constexpr double kSameAlignment_rad = 1e-6;
/// A person who is meant to stand in the reference pose has trunk and legs this upright.
constexpr double kUprightCosine = 0.94;  // 20°

}  // namespace

void BodyTracker::StartBlends(std::vector<Track>& before) {
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    Track& track = tracks_[i];
    Track& old = before[i];
    if (!old.started || !old.aligned || !track.aligned) {
      track.blend.Stop();
      continue;  // nobody has seen anything worth keeping
    }
    const Eigen::Quaterniond& q_earth_sensor = track.last.q_earth_sensor;
    const Eigen::Quaterniond q_new = track.alignment.Apply(q_earth_sensor).normalized();
    const Eigen::Quaterniond q_old =
        old.blend.Apply(old.alignment.Apply(q_earth_sensor).normalized(), shown_at_);
    if (math::AngleBetween_rad(q_old, q_new) > kSameAlignment_rad) {
      track.blend.Start(q_old, q_new, shown_at_, DurationFromSeconds(config_.blend_s));
      headings_.Forget(static_cast<body::Segment>(i));
    }
  }
}

void BodyTracker::FoldHeadings() {
  for (body::SegmentDefinition& segment : definition_.segments) {
    Track& track = tracks_[body::Index(segment.segment)];
    if (track.turned_rad != 0.0) {
      segment.heading_correction_rad = track.alignment.heading_correction_rad();
      track.turned_rad = 0.0;
    }
  }
}

void BodyTracker::TrackHeadings(SegmentSet measured, Time at) {
  const std::optional<Time> before = std::exchange(headings_at_, at);
  if (!config_.heading_tracking || definition_.heading != HeadingReference::kArbitrary || !before ||
      at < *before) {
    return;
  }
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    headings_use_[i] = (measured & BitOf(static_cast<body::Segment>(i))) != 0 &&
                       tracks_[i].aligned && !tracks_[i].blend.active();
  }
  const body::PerSegment<double>& turn_rad =
      headings_.Update(ToSeconds(at - *before), headings_use_, pose_.q_earth_segment);
  // Arms: once for each stretch of walking that is long enough.
  walked_s_ = headings_.walking() ? walked_s_ + ToSeconds(at - *before) : 0.0;
  if (walked_s_ > BodyCalibrator::kSurvey_s) {
    walked_s_ = 0.0;
    body::PerSegment<double> correction_rad{};
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      correction_rad[i] = tracks_[i].alignment.heading_correction_rad();
    }
    for (const auto& seen : calibrator_.SurveyArms(tick_.expected(), correction_rad)) {
      headings_.Observe(seen.segment, seen.error_rad, seen.sigma_rad);
    }
  }
  bool fold = false;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (turn_rad[i] != 0.0) {
      tracks_[i].alignment.TurnHeading(turn_rad[i]);
      tracks_[i].turned_rad += turn_rad[i];
      fold = fold || std::abs(tracks_[i].turned_rad) > kFoldBeyond_rad;
    }
  }
  if (fold) {
    FoldHeadings();
    ++definition_.revision;
    definition_changed_ = true;
  }
}

void BodyTracker::ChooseAutomatic(bool restored) {
  const bool all_aligned = std::all_of(
      definition_.segments.begin(), definition_.segments.end(),
      [](const body::SegmentDefinition& segment) { return !segment.tracked || segment.aligned; });
  if (!config_.automatic_calibration || tick_.expected() == 0) {
    automatic_ = Automatic::kNothing;
  } else if (!all_aligned) {
    automatic_ = Automatic::kStanceAndWalk;
  } else {
    // Offsets outlive a restart of the filters, headings do not.
    automatic_ = restored ? Automatic::kStance : Automatic::kNothing;
  }
}

void BodyTracker::Restore(body::BodyDefinition definition, Time now) {
  Redefine(std::move(definition), now);
  ChooseAutomatic(true);
}

bool BodyTracker::StandsUpright(const body::StandingPose& pose) const {
  bool any = false;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (!pose.known[i] || body::IsArm(static_cast<body::Segment>(i))) {
      continue;
    }
    const Eigen::Quaterniond q_earth_segment = tracks_[i].alignment.Apply(pose.q_earth_sensor[i]);
    any = true;
    if ((q_earth_segment * Eigen::Vector3d::UnitZ()).z() < kUprightCosine) {
      return false;
    }
  }
  return any;
}

void BodyTracker::CalibrateAutomatically(Time now) {
  const bool common_heading = definition_.heading != HeadingReference::kArbitrary;
  if (automatic_ == Automatic::kStanceAndWalk) {
    if (const auto outcome = calibrator_.Automatic(tick_.expected(), common_heading)) {
      FoldHeadings();
      body::BodyDefinition definition = definition_;
      calibrated_ = ApplyFit(*outcome, definition);
      Redefine(std::move(definition), now);
      calibrator_.Clear();
    }
    return;
  }
  if (automatic_ != Automatic::kStance) {
    return;
  }
  if (common_heading) {
    automatic_ = Automatic::kNothing;  // the earth keeps these headings
    return;
  }
  calibrator_.LookForStillness(tick_.expected());
  if (!calibrator_.still_now() || !StandsUpright(*calibrator_.still_now())) {
    return;
  }
  FoldHeadings();
  body::BodyDefinition definition = definition_;
  for (body::SegmentDefinition& segment : definition.segments) {
    const std::size_t i = body::Index(segment.segment);
    if (segment.tracked && calibrator_.still_now()->known[i]) {
      body::SensorAlignment alignment = tracks_[i].alignment;
      alignment.TurnHeading(
          -math::Heading_rad(alignment.Apply(calibrator_.still_now()->q_earth_sensor[i])));
      segment.heading_correction_rad = alignment.heading_correction_rad();
    }
  }
  Redefine(std::move(definition), now);
  calibrator_.Clear();
  calibrated_ = "headings set from the stance";
}

std::optional<std::string> BodyTracker::TakeCalibrated() {
  return std::exchange(calibrated_, std::nullopt);
}

}  // namespace limbcast::posture
