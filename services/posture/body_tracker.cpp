#include "services/posture/body_tracker.hpp"

#include <algorithm>
#include <utility>

#include "common/base/expects.hpp"
#include "common/body/default_body.hpp"
#include "common/body/sensor_place.hpp"
#include "common/math/rotation.hpp"

namespace limbcast::posture {
namespace {

TickAssemblerConfig MakeTickConfig(const PostureConfig& config) {
  return {.deadline = DurationFromSeconds(config.tick_deadline_s),
          .missing_after = DurationFromSeconds(config.missing_after_s)};
}

bool CannotBe(const StateInput& state) {
  return state.verdict == SampleVerdict::kRejectedDuplicate ||
         state.verdict == SampleVerdict::kRejectedOutOfOrder ||
         state.verdict == SampleVerdict::kRejectedTime || state.measured_at <= Time{} ||
         (state.started && !(std::abs(state.q_earth_sensor.norm() - 1.0) < 1e-3));
}

}  // namespace

BodyTracker::BodyTracker(const PostureConfig& config, body::BodyDefinition definition, Emit emit)
    : config_(config),
      emit_(std::move(emit)),
      definition_(std::move(definition)),
      kinematics_(definition_),
      tracks_(body::kSegmentCount, Track(DurationFromSeconds(config.still_window_s))),
      tick_(MakeTickConfig(config)),
      root_(definition_) {
  skeleton_.body_id = definition_.body_id;
  skeleton_.segments.resize(definition_.segments.size());
  Rebuild();
  ChooseAutomatic(true);
}

void BodyTracker::Rebuild() {
  SegmentSet expected = 0;
  for (const body::SegmentDefinition& segment : definition_.segments) {
    Track& track = tracks_[body::Index(segment.segment)];
    track.alignment =
        body::SensorAlignment(segment.q_sensor_segment, segment.heading_correction_rad);
    track.aligned = segment.aligned;
    track.turned_rad = 0.0;
    expected |= segment.tracked ? BitOf(segment.segment) : 0;
  }
  tick_.Expect(expected);
  kinematics_ = body::ForwardKinematics(definition_);
  root_.SetBody(definition_);
  for (const body::SegmentDefinition& segment : definition_.segments) {
    const auto told = config_.sensor_places_m.find(segment.segment);
    sensor_places_m_[body::Index(segment.segment)] =
        told != config_.sensor_places_m.end()
            ? told->second
            : body::UsualSensorPlace_m(definition_, segment.segment);
  }
}

bool BodyTracker::SetRoster(const roster::RosterEntry& entry) {
  bool changed = definition_.name != entry.person;
  definition_.name = entry.person;
  for (body::SegmentDefinition& segment : definition_.segments) {
    const auto found =
        std::find_if(entry.sensors.begin(), entry.sensors.end(),
                     [&](const auto& sensor) { return sensor.segment == segment.segment; });
    const bool tracked = found != entry.sensors.end();
    const SensorUid uid = tracked ? found->sensor_uid : SensorUid{};
    changed = changed || segment.tracked != tracked;
    segment.tracked = tracked;
    if (!tracked || uid == segment.sensor_uid) {
      continue;  // a segment that loses its sensor keeps its offset for its return
    }
    changed = true;
    if (segment.sensor_uid != SensorUid{}) {
      body::TakeAlignment(body::SegmentDefinition(), segment);
    }
    segment.sensor_uid = uid;
    tracks_[body::Index(segment.segment)].started = false;
    tracks_[body::Index(segment.segment)].window.Clear();
  }
  if (changed) {
    ++definition_.revision;
    definition_changed_ = true;
    Rebuild();
    ChooseAutomatic(true);
  }
  return changed;
}

void BodyTracker::Redefine(body::BodyDefinition definition, Time now) {
  definition.revision = definition_.revision + 1;
  definition.changed_at = now;
  definition_ = std::move(definition);
  definition_changed_ = true;
  std::vector<Track> before = tracks_;
  Rebuild();
  StartBlends(before);
  ChooseAutomatic(false);
}

void BodyTracker::OnPositionFix(const sensing::PositionFix& fix) {
  root_.OnPositionFix(fix.p_earth_body_m, fix.cov_m2, fix.measured_at);
}

bool BodyTracker::TakeDefinitionChanged() { return std::exchange(definition_changed_, false); }

StateFate BodyTracker::OnState(const StateInput& state, Time now) {
  const std::size_t index = body::Index(state.segment);
  if (index >= body::kSegmentCount || (tick_.expected() & BitOf(state.segment)) == 0) {
    return StateFate::kUnassigned;
  }
  if (body::Find(definition_, state.segment)->sensor_uid != state.sensor_uid) {
    return StateFate::kUnassigned;
  }
  if (CannotBe(state)) {
    return StateFate::kIgnored;
  }
  TickAssembler::Place place = tick_.Classify(state.segment, state.measured_at);
  if (place == TickAssembler::Place::kOld) {
    return StateFate::kIgnored;
  }
  if (place == TickAssembler::Place::kNewStart) {
    ++timeline_restarts_;
    tick_.Restart();
    calibrator_.Clear();
  }
  if (place == TickAssembler::Place::kNext && config_.output_rate_hz == 0.0) {
    Emit_(TickEnd::kOvertaken, tick_.measured_at());
  } else if (place == TickAssembler::Place::kNext) {
    tick_.Close();
  }

  const bool measured = state.started && IsUsed(state.verdict);
  Track& track = tracks_[index];
  if (measured) {
    track.last = state;
    track.started = true;
    track.window.Add(state.measured_at, state.q_earth_sensor);
    if (automatic_ != Automatic::kNothing || calibrator_.started() ||
        (config_.heading_tracking && state.heading == HeadingReference::kArbitrary)) {
      calibrator_.Add(state.segment, state.measured_at, state.q_earth_sensor,
                      state.free_accel_in_earth_m_s2);
    }
  }
  heard_at_ = now;
  if (place == TickAssembler::Place::kLate) {
    tick_.AddLate(state.segment, state.measured_at);
    return StateFate::kLate;
  }
  completed_by_ = state.stages;
  tick_.Add(state.segment, state.measured_at, measured, now);
  if (config_.output_rate_hz != 0.0) {
    measured_since_output_ |= measured ? BitOf(state.segment) : 0;
    next_output_at_ = next_output_at_.value_or(now);
  }
  if (tick_.full()) {
    if (config_.output_rate_hz == 0.0) {
      Emit_(TickEnd::kComplete, tick_.measured_at());
    } else {
      tick_.Close();
    }
  }
  return StateFate::kUsed;
}

std::optional<Time> BodyTracker::due() const {
  return config_.output_rate_hz == 0.0 ? tick_.deadline() : next_output_at_;
}

void BodyTracker::OnDue(Time now) {
  const std::optional<Time> at = due();
  if (!at || *at > now) {
    return;
  }
  if (config_.output_rate_hz == 0.0) {
    Emit_(TickEnd::kDeadline, tick_.measured_at());
    return;
  }
  if (now - heard_at_ > DurationFromSeconds(config_.missing_after_s)) {
    Emit_(TickEnd::kRate, now);  // the last one for now: everything is missing
    next_output_at_.reset();
    return;
  }
  Emit_(TickEnd::kRate, now);
  // From the time it was due, so that the rate holds; missed ones are not made up for.
  const Duration period = DurationFromSeconds(1.0 / config_.output_rate_hz);
  *next_output_at_ += period * (1 + (now - *next_output_at_) / period);
}

void BodyTracker::Emit_(TickEnd end, Time at) {
  const bool fixed_rate = end == TickEnd::kRate;
  const SegmentSet measured =
      fixed_rate ? std::exchange(measured_since_output_, 0) : tick_.measured();
  const SegmentSet missing = tick_.missing(at);
  if (!fixed_rate) {
    tick_.Close();
  }
  PoseSegments(at, measured, missing);
  NoteHeading(measured);
  FillSkeleton(at, measured, missing);
  const bool live = std::any_of(pose_.known.begin(), pose_.known.end(), std::identity());
  emit_(skeleton_, end, live);
  shown_at_ = at;
  TrackHeadings(measured, at);
  CalibrateAutomatically(at);
}

void BodyTracker::PoseSegments(Time at, SegmentSet measured, SegmentSet missing) {
  const Duration max_extrapolation = DurationFromSeconds(config_.max_extrapolation_s);
  for (const body::SegmentDefinition& segment : definition_.segments) {
    const std::size_t i = body::Index(segment.segment);
    const SegmentSet bit = BitOf(segment.segment);
    Track& track = tracks_[i];
    pose_.known[i] = segment.tracked && track.started && (missing & bit) == 0;
    motion_[i] = {.usable = config_.contacts && pose_.known[i] && track.aligned,
                  .rate_rad_s = track.last.w_earth_sensor_in_sensor_rad_s.norm(),
                  .accel_m_s2 = track.last.free_accel_in_earth_m_s2.norm()};
    if (!pose_.known[i]) {
      continue;
    }
    const Duration age = at - track.last.measured_at;
    Eigen::Quaterniond q_earth_sensor = track.last.q_earth_sensor;
    if (age > Duration::zero()) {
      const double dt_s = ToSeconds(std::min(age, max_extrapolation));
      q_earth_sensor =
          q_earth_sensor *
          math::ExpSO3(dt_s * track.last.w_earth_sensor_in_sensor_rad_s.cast<double>());
    }
    pose_.q_earth_segment[i] =
        track.blend.Apply(track.alignment.Apply(q_earth_sensor).normalized(), at);
    pose_.confidence[i] =
        Confidence({.sigma_rad = track.last.sigma_rad,
                    .aligned = track.aligned,
                    .alignment_quality = segment.alignment_quality,
                    .degraded = track.last.degraded,
                    .disturbed = track.last.magnetic_state == MagneticState::kDisturbed,
                    .age = (measured & bit) != 0 ? Duration::zero() : age});
  }
  kinematics_.Fill(pose_);
  if (config_.joint_limits) {
    kinematics_.LimitJoints(config_.joint_softness_rad, pose_);
  }
  kinematics_.Place(Eigen::Vector3d::Zero(), pose_);
  if (config_.positions) {
    UsePositions(at);
  }
  root_.Update(at, motion_, pose_);
}

void BodyTracker::NoteHeading(SegmentSet measured) {
  if (measured == 0 || measured != tick_.expected()) {
    return;  // only a whole body says what its heading means
  }
  HeadingReference least = HeadingReference::kTrue;
  for (const body::SegmentDefinition& segment : definition_.segments) {
    if (segment.tracked) {
      least = std::min(least, tracks_[body::Index(segment.segment)].last.heading);
    }
  }
  if (least != definition_.heading) {
    definition_.heading = least;
    ++definition_.revision;
    definition_changed_ = true;
  }
}

void BodyTracker::FillSkeleton(Time at, SegmentSet measured, SegmentSet missing) {
  ++skeleton_.sequence;
  skeleton_.definition_revision = definition_.revision;
  skeleton_.measured_at = at;
  skeleton_.stages = completed_by_;
  skeleton_.contacts = root_.contacts();
  skeleton_.complete = tick_.expected() != 0 && measured == tick_.expected();
  for (std::size_t row = 0; row < definition_.segments.size(); ++row) {
    const body::SegmentDefinition& definition = definition_.segments[row];
    const std::size_t i = body::Index(definition.segment);
    const SegmentSet bit = BitOf(definition.segment);
    body::SegmentPose& segment = skeleton_.segments[row];
    segment.segment = definition.segment;
    segment.q_earth_segment = math::Canonical(pose_.q_earth_segment[i]).cast<float>();
    segment.p_earth_segment_m = pose_.p_earth_segment_m[i].cast<float>();
    segment.confidence = pose_.confidence[i];
    if (!definition.tracked) {
      segment.status = body::SegmentStatus::kFilled;
    } else if ((missing & bit) != 0 || !tracks_[i].started) {
      segment.status = body::SegmentStatus::kMissing;
      segment.confidence = 0.0F;
    } else {
      segment.status =
          (measured & bit) != 0 ? body::SegmentStatus::kTracked : body::SegmentStatus::kStale;
    }
  }
}

BodyTracker::SensorView BodyTracker::View(body::Segment segment) const {
  SensorView view;
  const Track& track = tracks_[body::Index(segment)];
  view.started =
      track.started && (tick_.missing(tick_.measured_at()) & BitOf(segment)) == 0 &&
      tick_.measured_at() - track.last.measured_at <= DurationFromSeconds(config_.still_window_s);
  if (view.started) {
    view.q_earth_sensor = track.last.q_earth_sensor;
    view.average = track.window.Average();
  }
  return view;
}

}  // namespace limbcast::posture
