#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <unordered_map>
#include <variant>

#include "common/base/clock.hpp"
#include "common/base/ids.hpp"
#include "common/filters/filter_batches.hpp"
#include "common/runtime/bounded_queue.hpp"
#include "common/runtime/latency_histogram.hpp"
#include "services/fusion/body_positions.hpp"
#include "services/fusion/filter_store.hpp"
#include "services/fusion/fusion_config.hpp"
#include "services/fusion/fusion_counters.hpp"
#include "services/fusion/router.hpp"
#include "services/fusion/sensor_track.hpp"
#include "services/fusion/state_publisher.hpp"

namespace limbcast::fusion {

/// Latencies of all workers, by stage. Thread-safe.
struct FusionLatencies {
  runtime::LatencyHistogram gateway_to_fusion;  ///< published by the gateway → received here
  runtime::LatencyHistogram queue;              ///< received here → a worker takes it
  runtime::LatencyHistogram step;               ///< a worker takes it → ready to publish
  runtime::LatencyHistogram fusion;             ///< received here → ready to publish
};

/// One shard: a queue, and the sensors of the bodies that belong to it. Offer from any thread,
/// Drain from one. Nothing else touches its sensors, so a filter step holds no lock.
///
/// Filters of one kind and configuration sit in batches (filters/filter_batches). What is queued is
/// taken in rounds, at most one sample of each sensor in one, and the batches step once in a round.
/// What a sensor's filter says does not depend on who else is in its batch or its round.
class FusionWorker {
 public:
  using Work = std::variant<sensing::MargSample, sensing::FusedOrientation, sensing::MarkerPosition,
                            std::shared_ptr<const BodyPlan>, std::shared_ptr<FilterSnapshot>>;

  /// What is referred to outlives it. New sensors go on from `saved`, if they are there.
  FusionWorker(const FusionConfig& config, const FilterFactory& factory, const Clock& clock,
               StateWriters& writers, FusionLatencies& latencies, SavedFilters& saved);

  /// Queues a sample. False: the queue is full. (Some places are kept for plans.)
  [[nodiscard]] bool Offer(const sensing::MargSample& sample, const Reception& reception) {
    return queue_.TryPush({reception, sample}, kKeptForPlans);
  }
  [[nodiscard]] bool Offer(const sensing::FusedOrientation& orientation,
                           const Reception& reception) {
    return queue_.TryPush({reception, orientation}, kKeptForPlans);
  }
  [[nodiscard]] bool Offer(const sensing::MarkerPosition& marker, const Reception& reception) {
    return queue_.TryPush({reception, marker}, kKeptForPlans);
  }
  /// Queues a change of who is who, in order with the samples. False: even the kept places are
  /// full.
  [[nodiscard]] bool Offer(std::shared_ptr<const BodyPlan> plan) {
    return queue_.TryPush({{}, std::move(plan)});
  }

  /// Queues the question what the filters know. False: the queue is full.
  [[nodiscard]] bool Offer(std::shared_ptr<FilterSnapshot> snapshot) {
    return queue_.TryPush({{}, std::move(snapshot)}, kKeptForPlans);
  }

  /// Filters and publishes everything that is queued.
  void Drain();

  /// What the filters know now. Not while Drain runs.
  void SaveFilters(FilterSnapshot& snapshot) const;

  [[nodiscard]] const CounterCells& counters() const { return counters_; }

 private:
  struct Item {
    Reception reception;
    Work work;
  };
  static constexpr std::size_t kKeptForPlans = 32;
  static constexpr std::size_t kFlushEvery = 32;  // samples, when the queue never gets empty

  struct Tracked;
  struct InRound {
    Tracked* tracked = nullptr;
    Item item;
    Time taken_at{};
    SensorTrack::Output output;
  };

  void Take(InRound& next);
  void FinishRound();
  void Handle(const sensing::FusedOrientation& orientation, const Reception& reception);
  void Handle(const sensing::MarkerPosition& marker, const Reception& reception);
  void Handle(const std::shared_ptr<const BodyPlan>& plan, const Reception& reception);
  void Handle(const std::shared_ptr<FilterSnapshot>& snapshot, const Reception& reception);
  void AddPosition(BodyId body_id, const sensing::MargSample& sample,
                   const SensorTrack::Output& output);
  void PublishLagged();
  [[nodiscard]] Tracked* Find(SensorUid sensor_uid);
  void Publish(const SensorTrack::Output& output, Time published_at, const Reception& reception,
               Time taken_at);
  void DisposeAbsent(BodyId body_id, const BodyPlan& plan);

  struct Tracked {
    Tracked(BodyId body, const TrackPlan& plan, const FilterFactory& factory, Duration max_future,
            double declination_rad)
        : body_id(body), track(body, plan, factory, max_future, declination_rad) {}
    BodyId body_id;
    SensorTrack track;
  };

  filters::FilterBatches batches_;
  const FilterFactory seated_;  // the service's factory, with a seat for what it makes
  const Clock& clock_;
  FusionLatencies& latencies_;
  SavedFilters& saved_;
  const Duration max_future_;
  const double declination_rad_;
  runtime::BoundedQueue<Item> queue_;
  std::array<InRound, kFlushEvery> round_;
  std::size_t round_size_ = 0;
  std::unordered_map<SensorUid, Tracked> tracks_;
  const PositionConfig position_config_;
  std::unordered_map<BodyId, BodyPositions> positions_;  // of bodies that have any
  CounterCells counters_;
  StatePublisher publisher_;
};

}  // namespace limbcast::fusion
