#include "services/fusion/fusion_worker.hpp"

#include <algorithm>
#include <utility>

namespace limbcast::fusion {

namespace {

bool Names(const BodyPlan& plan, SensorUid sensor_uid) {
  return std::any_of(plan.tracks.begin(), plan.tracks.end(),
                     [&](const TrackPlan& track) { return track.sensor_uid == sensor_uid; });
}

}  // namespace

FusionWorker::FusionWorker(const FusionConfig& config, const FilterFactory& factory,
                           const Clock& clock, bus::Writer<body::SegmentState>& writer,
                           FusionLatencies& latencies)
    : factory_(factory),
      clock_(clock),
      writer_(writer),
      latencies_(latencies),
      max_future_(DurationFromSeconds(config.max_future_s)),
      queue_(config.queue_capacity) {}

void FusionWorker::Drain() {
  counters_.SawQueue(queue_.size());
  std::size_t unflushed = 0;
  while (queue_.TryPop(item_)) {
    std::visit([this](const auto& work) { Handle(work, item_.reception); }, item_.work);
    if (++unflushed == kFlushEvery) {
      writer_.Flush();
      unflushed = 0;
    }
  }
  if (unflushed > 0) {
    writer_.Flush();
  }
}

void FusionWorker::Handle(const sensing::MargSample& sample, const Reception& reception) {
  HandleSample(sample, reception);
}

void FusionWorker::Handle(const sensing::FusedOrientation& orientation,
                          const Reception& reception) {
  HandleSample(orientation, reception);
}

template <typename Sample>
void FusionWorker::HandleSample(const Sample& sample, const Reception& reception) {
  const auto found = tracks_.find(sample.sensor_uid);
  if (found == tracks_.end()) {
    // Its plan was refused for lack of room: as good as not assigned.
    counters_.Add(SampleVerdict::kRejectedUnassigned);
    return;
  }
  const Time taken_at = clock_.Now();
  const SensorTrack::Output output = found->second.track.Update(sample, reception);
  const Time done_at = clock_.Now();
  for (body::SegmentState& state : output.states) {
    state.stages.fusion_published_at = done_at;
    counters_.AddPublished(writer_.Write(state).ok());
  }
  if (output.probe) {
    counters_.AddProbe();
    return;
  }
  counters_.Add(output.verdict);
  if (output.lost != 0) {
    counters_.AddLost(output.lost);
  }
  latencies_.gateway_to_fusion.Record(reception.received_at - sample.published_at);
  latencies_.queue.Record(taken_at - reception.received_at);
  latencies_.step.Record(done_at - taken_at);
  latencies_.fusion.Record(done_at - reception.received_at);
}

void FusionWorker::Handle(const std::shared_ptr<const BodyPlan>& plan,
                          const Reception& /*reception*/) {
  DisposeAbsent(plan->body_id, *plan);
  std::erase_if(tracks_, [&](const auto& entry) {
    return entry.second.body_id == plan->body_id && !Names(*plan, entry.first);
  });
  for (const TrackPlan& track : plan->tracks) {
    const auto found = tracks_.find(track.sensor_uid);
    if (found != tracks_.end() && found->second.body_id == plan->body_id) {
      found->second.track.Apply(track, factory_);
    } else {
      tracks_.erase(track.sensor_uid);
      tracks_.try_emplace(track.sensor_uid, plan->body_id, track, factory_, max_future_);
    }
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
    for (const std::uint8_t slot : {std::uint8_t{0}, std::uint8_t{1}}) {
      if (slot == 0 ? slot_0_ends : slot_1_ends) {
        body::SegmentState key;
        key.body_id = body_id;
        key.segment = segment;
        key.slot = slot;
        counters_.AddPublished(writer_.Dispose(key).ok());
      }
    }
  }
}

}  // namespace limbcast::fusion
