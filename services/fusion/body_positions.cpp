#include "services/fusion/body_positions.hpp"

#include <algorithm>
#include <utility>

#include "common/math/rotation.hpp"

namespace limbcast::fusion {
namespace {

// The sensor that the plan has on a segment.
const TrackPlan* SensorOn(const BodyPlan& plan, body::Segment segment) {
  const auto found = std::find_if(plan.tracks.begin(), plan.tracks.end(),
                                  [&](const TrackPlan& track) { return track.segment == segment; });
  return found == plan.tracks.end() ? nullptr : &*found;
}

template <typename Tracks>
auto Find(Tracks& tracks, SensorUid sensor_uid) {
  return std::find_if(tracks.begin(), tracks.end(),
                      [&](const auto& track) { return track.sensor_uid == sensor_uid; });
}

void Put(const SegmentPosition& position, body::SegmentState& state) {
  state.has_position = true;
  state.position_fill = position.fill;
  state.p_earth_sensor_m = position.p_earth_sensor_m.cast<float>();
  state.v_earth_sensor_m_s = position.v_earth_sensor_m_s.cast<float>();
  state.cov_position_m2 = position.cov_position_m2.cast<float>();
}

}  // namespace

void BodyPositions::Apply(const BodyPlan& plan) {
  std::vector<Coil> coils;
  std::vector<Marker> markers;
  const TrackPlan* const source =
      config_.coils.source ? SensorOn(plan, *config_.coils.source) : nullptr;
  if (source == nullptr) {
    source_.reset();
  } else if (!source_ || source_->sensor_uid != source->sensor_uid) {
    source_.emplace(source->sensor_uid);
    coils_.clear();  // tracked from another place
  }
  for (const body::Segment segment : config_.coils.sensors) {
    const TrackPlan* const sensor = source == nullptr ? nullptr : SensorOn(plan, segment);
    if (sensor == nullptr) {
      continue;
    }
    const auto old = Find(coils_, sensor->sensor_uid);
    coils.push_back({.sensor_uid = sensor->sensor_uid,
                     .track = old != coils_.end()
                                  ? std::move(old->track)
                                  : std::make_unique<CoilTrack>(config_.coils, config_.lag_s)});
  }
  for (const body::Segment segment : config_.markers.segments) {
    const TrackPlan* const sensor = SensorOn(plan, segment);
    if (sensor == nullptr) {
      continue;
    }
    const auto old = Find(markers_, sensor->sensor_uid);
    const bool stays = old != markers_.end() && old->segment == segment;
    markers.push_back(
        {.sensor_uid = sensor->sensor_uid,
         .segment = segment,
         .track = stays ? std::move(old->track)
                        : std::make_unique<MarkerTrack>(config_.markers.filter, config_.lag_s)});
  }
  coils_ = std::move(coils);
  markers_ = std::move(markers);
}

void BodyPositions::OnMarker(const sensing::MarkerPosition& marker) {
  for (Marker& known : markers_) {
    if (body::Index(known.segment) == marker.marker) {
      known.track->OnMarker(marker);
    }
  }
}

std::optional<SegmentPosition> BodyPositions::Track(const sensing::MargSample& sample,
                                                    body::SegmentState& state) {
  std::optional<SegmentPosition> position;
  state.position_reference = PositionReference::kEarth;
  state.position_from = state.segment;
  if (const auto coil = Find(coils_, sample.sensor_uid);
      coil != coils_.end() && source_->started && source_->sample) {
    position = coil->track->Update(sample, *source_->sample, source_->q_earth_sensor);
    if (position) {
      state.position_reference = PositionReference::kSensor;
      state.position_from = *config_.coils.source;
    }
  }
  if (const auto marker = Find(markers_, sample.sensor_uid); marker != markers_.end()) {
    std::optional<Eigen::Quaterniond> q_earth_sensor;
    if (state.started) {
      q_earth_sensor = state.q_earth_sensor;
    }
    if (const auto seen = marker->track->Update(sample, q_earth_sensor)) {
      position = seen;
      state.position_reference = PositionReference::kEarth;
      state.position_from = state.segment;
    }
  }
  return position;
}

// As Track: a segment with both has the marker's.
body::SegmentState* BodyPositions::Lagged(const body::SegmentState& now) {
  body::SegmentState* found = nullptr;
  if (const auto coil = Find(coils_, now.sensor_uid); coil != coils_.end()) {
    if (const auto lagged = coil->track->Lagged()) {
      FillLagged(*lagged, "coils, lagged", now);
      lagged_.position_reference = PositionReference::kSensor;
      lagged_.position_from = *config_.coils.source;
      found = &lagged_;
    }
  }
  if (const auto marker = Find(markers_, now.sensor_uid); marker != markers_.end()) {
    if (const auto lagged = marker->track->Lagged()) {
      FillLagged(*lagged, "marker, lagged", now);
      lagged_.position_reference = PositionReference::kEarth;
      lagged_.position_from = now.segment;
      found = &lagged_;
    }
  }
  return found;
}

void BodyPositions::FillLagged(const LaggedPosition& from, std::string_view filter,
                               const body::SegmentState& now) {
  lagged_.body_id = now.body_id;
  lagged_.segment = now.segment;
  lagged_.slot = body::kLaggedSlot;
  lagged_.sensor_uid = now.sensor_uid;
  lagged_.sequence = now.sequence;
  lagged_.verdict = now.verdict;
  lagged_.started = true;
  lagged_.measured_at = from.measured_at;
  lagged_.stages = now.stages;
  lagged_.q_earth_sensor = math::Canonical(from.q_earth_sensor);
  lagged_.filter = filter;
  Put(from.position, lagged_);
}

void BodyPositions::Update(const sensing::MargSample& sample, body::SegmentState& state) {
  state.has_position = false;
  state.position_fill = FillKind::kNone;
  if (!IsUsed(state.verdict) || sample.Has(sensing::kProbe)) {
    return;
  }
  if (source_ && source_->sensor_uid == sample.sensor_uid) {
    source_->sample = sample;
    source_->q_earth_sensor = state.q_earth_sensor;
    source_->started = state.started;
  }
  if (const std::optional<SegmentPosition> position = Track(sample, state)) {
    Put(*position, state);
  }
}

}  // namespace limbcast::fusion
