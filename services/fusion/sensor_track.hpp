#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/base/time.hpp"
#include "common/base/verdict.hpp"
#include "common/body/segment_state.hpp"
#include "common/filters/filter.hpp"
#include "common/sensing/fused_orientation.hpp"
#include "common/sensing/marg_sample.hpp"
#include "services/fusion/fusion_config.hpp"
#include "services/fusion/router.hpp"
#include "services/fusion/sequence_tracker.hpp"

namespace limbcast::fusion {

/// When and behind what a sample came; what the intake knows and the sample does not.
struct Reception {
  Time received_at{};
  std::uint64_t overloads = 0;  ///< refused samples of this sensor before this one
};

/// One sensor on one segment: its numbers, its filters, its counters. Each sample gives one state
/// (two with a filter beside it), used or refused. Thread-compatible; allocates only in Apply, and
/// once for a sensor that sends samples and orientations.
class SensorTrack {
 public:
  /// States of one sample, slot 0 first; valid until the next call. `lost` is the change of
  /// lost_count by this sample.
  struct Output {
    std::span<body::SegmentState> states;
    SampleVerdict verdict = SampleVerdict::kNoData;
    bool probe = false;
    std::int64_t lost = 0;
  };

  /// @param declination_rad  what is published of a filter is turned by it from magnetic to true
  ///                         north. Range: [−π, π].
  SensorTrack(BodyId body_id, const TrackPlan& plan, const FilterFactory& factory,
              Duration max_future, double declination_rad = 0.0);

  /// A new plan for the same sensor and body. A filter that is replaced goes on until the new one,
  /// started from the measurements, has an orientation; if the new one ran beside it, it takes over
  /// at once.
  void Apply(const TrackPlan& plan, const FilterFactory& factory);

  [[nodiscard]] Output Update(const sensing::MargSample& sample, const Reception& reception);

  /// Update in two halves: between them the batches run that the filters sit in
  /// (filters/filter_batches). Only Finish may follow Begin. `sample` stays where it is until then.
  void Begin(const sensing::MargSample& sample, const Reception& reception);
  [[nodiscard]] Output Finish();
  [[nodiscard]] bool begun() const { return begun_ != nullptr; }

  /// A sensor with a filter on board: its orientation passes through as filter "onboard", as slot
  /// 0, or as slot 1 when the sensor's raw samples are filtered here too (no state when slot 1 is
  /// taken by a filter beside).
  [[nodiscard]] Output Update(const sensing::FusedOrientation& orientation,
                              const Reception& reception);

  /// The filter of slot 0, to save its state.
  [[nodiscard]] const filters::OrientationFilter& filter() const { return *filter_; }
  /// Lets it go on from a state that it saved. False: that was of another filter, and it starts
  /// anew.
  [[nodiscard]] bool Restore(std::span<const std::byte> state) {
    return filter_->RestoreState(state).ok();
  }

  [[nodiscard]] body::Segment segment() const { return plan_.segment; }
  [[nodiscard]] bool has_beside() const { return beside_ != nullptr; }

 private:
  using FilterPtr = std::unique_ptr<filters::OrientationFilter>;

  // What is counted for one stream of numbered samples.
  struct Source {
    SequenceTracker sequence;
    VerdictCounters verdicts;
    std::int64_t lost = 0;
  };

  SequenceTracker::Arrival Arrive(Source& source, std::uint32_t sequence, Time measured_at,
                                  const Reception& reception, std::int64_t& lost);
  [[nodiscard]] SampleVerdict CheckTime(Time measured_at, const Reception& reception) const;
  [[nodiscard]] SampleVerdict CheckOrder(Time measured_at);
  [[nodiscard]] std::size_t filter_slots() const { return has_beside() ? 2 : 1; }
  void ProvideSlots(std::size_t count);
  void TakeIncoming();
  void Judge(const sensing::MargSample& sample, const Reception& reception);
  template <typename Step>
  Output Answer(const sensing::MargSample& sample, Step step);
  static void Submit(const FilterPtr& filter, const sensing::MargSample& sample);
  [[nodiscard]] static SampleVerdict Take(const FilterPtr& filter,
                                          const sensing::MargSample& sample);
  void Start(body::SegmentState& state, std::uint32_t sequence, Time measured_at,
             Time gateway_published_at, const Reception& reception) const;
  void Fill(body::SegmentState& state, const filters::OrientationFilter& filter) const;
  void TurnToTrueNorth(body::SegmentState& state) const;
  static void Count(body::SegmentState& state, const Source& source, SampleVerdict verdict);

  const BodyId body_id_;
  const Duration max_future_;
  const Eigen::Quaterniond q_true_magnetic_;
  const bool has_declination_;
  TrackPlan plan_;
  FilterPtr filter_;
  FilterPtr incoming_;  // takes the place of filter_ as soon as it has an orientation
  FilterPtr beside_;
  Source marg_;
  Source onboard_;
  std::optional<Time> onboard_used_at_;
  std::uint32_t onboard_old_run_ = 0;
  std::uint64_t overloads_seen_;
  bool marg_seen_ = false;
  const sensing::MargSample* begun_ = nullptr;  // between Begin and Finish
  Output output_;                               // of that sample, so far
  std::vector<body::SegmentState> states_;      // by slot
};

}  // namespace limbcast::fusion
