#include "services/fusion/fusion_worker.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/units/units.hpp"

namespace limbcast::fusion {

namespace {

bool Names(const BodyPlan& plan, SensorUid sensor_uid) {
  return std::any_of(plan.tracks.begin(), plan.tracks.end(),
                     [&](const TrackPlan& track) { return track.sensor_uid == sensor_uid; });
}

}  // namespace

FusionWorker::FusionWorker(const FusionConfig& config, const FilterFactory& factory,
                           const Clock& clock, StateWriters& writers, FusionLatencies& latencies,
                           SavedFilters& saved)
    : seated_([this, &factory](std::string_view name) {
        auto made = factory(name);
        return made.ok() ? batches_.Seat(std::move(*made)) : std::move(made);
      }),
      clock_(clock),
      latencies_(latencies),
      saved_(saved),
      max_future_(DurationFromSeconds(config.max_future_s)),
      declination_rad_(units::RadFromDeg(config.declination_deg)),
      queue_(config.queue_capacity),
      position_config_(config.position),
      publisher_(writers, counters_) {}

void FusionWorker::Drain() {
  counters_.SawQueue(queue_.size());
  std::size_t unflushed = 0;
  while (queue_.TryPop(round_[round_size_].item)) {
    Take(round_[round_size_]);
    if (++unflushed == kFlushEvery) {
      FinishRound();
      publisher_.Flush();
      unflushed = 0;
    }
  }
  FinishRound();
  if (unflushed > 0) {
    publisher_.Flush();
  }
}

// Adds a sample to the round. What is not to be filtered ends the round and is handled at once.
void FusionWorker::Take(InRound& next) {
  const auto* const sample = std::get_if<sensing::MargSample>(&next.item.work);
  if (sample == nullptr) {
    FinishRound();
    std::visit(
        [&](const auto& work) {
          if constexpr (!std::is_same_v<decltype(work), const sensing::MargSample&>) {
            Handle(work, next.item.reception);
          }
        },
        next.item.work);
    return;
  }
  Tracked* const tracked = Find(sample->sensor_uid);
  if (tracked == nullptr) {
    return;
  }
  InRound* place = &next;
  if (tracked->track.begun()) {
    FinishRound();
    if (place != &round_.front()) {
      std::swap(round_.front().item, next.item);
      place = &round_.front();
    }
  }
  place->tracked = tracked;
  place->taken_at = clock_.Now();
  tracked->track.Begin(std::get<sensing::MargSample>(place->item.work), place->item.reception);
  ++round_size_;
}

void FusionWorker::FinishRound() {
  if (round_size_ == 0) {
    return;
  }
  batches_.Run();
  for (std::size_t i = 0; i < round_size_; ++i) {
    InRound& in_round = round_[i];
    in_round.output = in_round.tracked->track.Finish();
    const auto& sample = std::get<sensing::MargSample>(in_round.item.work);
    AddPosition(in_round.tracked->body_id, sample, in_round.output);
    Publish(in_round.output, sample.published_at, in_round.item.reception, in_round.taken_at);
  }
  if (position_config_.lag_s > 0.0 && !positions_.empty()) {
    PublishLagged();
  }
  round_size_ = 0;
}

void FusionWorker::Handle(const sensing::FusedOrientation& orientation,
                          const Reception& reception) {
  if (Tracked* const tracked = Find(orientation.sensor_uid)) {
    const Time taken_at = clock_.Now();
    Publish(tracked->track.Update(orientation, reception), orientation.published_at, reception,
            taken_at);
  }
}

void FusionWorker::Handle(const sensing::MarkerPosition& marker, const Reception&) {
  if (const auto body = positions_.find(marker.body_id); body != positions_.end()) {
    body->second.OnMarker(marker);
  }
}

// In the order of the queue, which is the same for any number of workers.
void FusionWorker::AddPosition(BodyId body_id, const sensing::MargSample& sample,
                               const SensorTrack::Output& output) {
  if (const auto body = positions_.find(body_id); body != positions_.end()) {
    body->second.Update(sample, output.states.front());
    counters_.AddPosition(output.states.front().has_position);
  }
}

// What smoothing made known of earlier times, after all that is live is on its way.
void FusionWorker::PublishLagged() {
  publisher_.Flush();
  for (std::size_t i = 0; i < round_size_; ++i) {
    const body::SegmentState& now = round_[i].output.states.front();
    const auto body = positions_.find(now.body_id);
    if (body == positions_.end()) {
      continue;
    }
    if (body::SegmentState* const lagged = body->second.Lagged(now)) {
      lagged->stages = now.stages;
      publisher_.Write(*lagged);
    }
  }
}

FusionWorker::Tracked* FusionWorker::Find(SensorUid sensor_uid) {
  const auto found = tracks_.find(sensor_uid);
  if (found == tracks_.end()) {
    // Its plan was refused for lack of room: as good as not assigned.
    counters_.Add(SampleVerdict::kRejectedUnassigned);
    return nullptr;
  }
  return &found->second;
}

void FusionWorker::Publish(const SensorTrack::Output& output, Time published_at,
                           const Reception& reception, Time taken_at) {
  const Time done_at = clock_.Now();
  for (body::SegmentState& state : output.states) {
    state.stages.fusion_published_at = done_at;
    publisher_.Write(state);
  }
  if (output.probe) {
    counters_.AddProbe();
    return;
  }
  counters_.Add(output.verdict);
  if (output.lost != 0) {
    counters_.AddLost(output.lost);
  }
  latencies_.gateway_to_fusion.Record(reception.received_at - published_at);
  latencies_.queue.Record(taken_at - reception.received_at);
  latencies_.step.Record(done_at - taken_at);
  latencies_.fusion.Record(done_at - reception.received_at);
}

void FusionWorker::Handle(const std::shared_ptr<const BodyPlan>& plan, const Reception&) {
  DisposeAbsent(plan->body_id, *plan);
  std::erase_if(tracks_, [&](const auto& entry) {
    return entry.second.body_id == plan->body_id && !Names(*plan, entry.first);
  });
  for (const TrackPlan& track : plan->tracks) {
    const auto found = tracks_.find(track.sensor_uid);
    if (found != tracks_.end() && found->second.body_id == plan->body_id) {
      found->second.track.Apply(track, seated_);
    } else {
      tracks_.erase(track.sensor_uid);
      Tracked& tracked = tracks_
                             .try_emplace(track.sensor_uid, plan->body_id, track, seated_,
                                          max_future_, declination_rad_)
                             .first->second;
      const std::vector<std::byte> state = saved_.Take(track.sensor_uid);
      if (!state.empty() && tracked.track.Restore(state)) {
        counters_.AddRestored();
      }
    }
  }
  BodyPositions& positions = positions_.try_emplace(plan->body_id, position_config_).first->second;
  positions.Apply(*plan);
  if (positions.empty()) {
    positions_.erase(plan->body_id);
  }
}

void FusionWorker::Handle(const std::shared_ptr<FilterSnapshot>& snapshot, const Reception&) {
  SaveFilters(*snapshot);
  snapshot->complete.store(true, std::memory_order_release);
}

void FusionWorker::SaveFilters(FilterSnapshot& snapshot) const {
  for (const auto& [sensor_uid, tracked] : tracks_) {
    snapshot.Add(sensor_uid, tracked.track.filter());
  }
}

// Segments of the body that have no sensor under the new plan (or no second filter) are over.
void FusionWorker::DisposeAbsent(BodyId body_id, const BodyPlan& plan) {
  for (const auto& [sensor_uid, tracked] : tracks_) {
    if (tracked.body_id != body_id) {
      continue;
    }
    const body::Segment segment = tracked.track.segment();
    const auto successor =
        std::find_if(plan.tracks.begin(), plan.tracks.end(),
                     [&](const TrackPlan& track) { return track.segment == segment; });
    const bool slot_0_ends = successor == plan.tracks.end();
    const bool slot_1_ends =
        tracked.track.has_beside() && (slot_0_ends || successor->filters.beside.empty());
    const bool lagged_ends = position_config_.lag_s > 0.0 && slot_0_ends;
    for (const auto& [slot, ends] : {std::pair{std::uint8_t{0}, slot_0_ends},
                                     {std::uint8_t{1}, slot_1_ends},
                                     {body::kLaggedSlot, lagged_ends}}) {
      if (ends) {
        body::SegmentState key;
        key.body_id = body_id;
        key.segment = segment;
        key.slot = slot;
        publisher_.Dispose(key);
      }
    }
  }
  if (plan.tracks.empty()) {
    publisher_.DisposeBody(body_id);
  }
}

}  // namespace limbcast::fusion
