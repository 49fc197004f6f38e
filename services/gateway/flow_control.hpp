#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "common/body/segment_state.hpp"
#include "common/body/skeleton.hpp"
#include "services/gateway/ack_window.hpp"
#include "services/gateway/driver.hpp"
#include "services/gateway/gateway_config.hpp"
#include "services/gateway/link_probe.hpp"
#include "services/gateway/sample_publisher.hpp"

namespace limbcast::gateway {

/// What comes back from the pipeline: answers to link probes while the gateway waits, and as fast
/// as possible the answers to samples (segment states by sequence number) and, when posture is
/// waited for, to ticks (skeletons by time), which keep what is under way within the window.
/// Thread-safe: readers call On..., the worker the rest.
class FlowControl {
 public:
  /// Lanes for all sensors and bodies of `description`.
  FlowControl(const GatewayConfig& config, const DriverDescription& description);

  /// Probes are answered with anything measured from `now` on.
  void StartProbing(Time now);
  void StopProbing();
  [[nodiscard]] bool WayOpen() const;
  [[nodiscard]] std::string Missing() const;

  /// True when the worker, which waits for the way to open or for room (Full), may go on: wake it.
  bool OnState(const body::SegmentState& state);
  bool OnSkeleton(const body::Skeleton& skeleton);

  /// Notes a stamped tick before it is written. `streams` are those of the publisher.
  void Sent(const Batch& batch, const std::vector<SensorStream>& streams,
            const std::vector<std::size_t>& marg_streams,
            const std::vector<std::size_t>& orientation_streams, Time now);

  /// Counts what is over its deadline, then tells whether the window is full; nothing when a tick
  /// may be sent, else when to ask again without an answer.
  [[nodiscard]] std::optional<Time> Full(Time now);

  /// Everything sent has been answered or given up. Nothing when so, else when to ask again.
  [[nodiscard]] std::optional<Time> Outstanding(Time now);

  /// Nobody answers any more: the window means nothing until somebody does.
  [[nodiscard]] bool link_lost(Time now);
  /// Answers are still needed once the way is open: as fast as possible only.
  [[nodiscard]] bool needs_answers() const { return as_fast_; }
  /// Says that from the outside (the way never opened).
  void LoseLink(Time now);

  struct Counters {
    std::uint64_t samples_unanswered = 0;
    std::uint64_t ticks_unanswered = 0;
    std::uint64_t late_answers = 0;
    std::uint64_t link_losses = 0;
    bool link_lost = false;  ///< as of the last tick
  };
  [[nodiscard]] Counters counters() const;
  [[nodiscard]] std::uint64_t unanswered(SensorUid uid) const;

  /// States and skeletons must be listened to.
  [[nodiscard]] static bool NeedsStates(const GatewayConfig& config);
  [[nodiscard]] static bool NeedsSkeletons(const GatewayConfig& config);

 private:
  void Expire(Time now);
  [[nodiscard]] bool TakeWakeUp();
  std::size_t LaneOf(SensorUid uid, bool expected);

  const bool as_fast_;
  const bool by_posture_;
  mutable std::mutex mutex_;  // guards the rest
  LinkProbe probe_;
  bool probing_ = false;
  AckWindow samples_;
  AckWindow ticks_;
  std::vector<bool>
      has_marg_;  // of each lane: its marg samples are followed, else its orientations
  std::unordered_map<SensorUid, std::size_t> lane_of_;
  std::unordered_map<BodyId, std::size_t> body_lane_of_;  // the index in the description too
  std::vector<Time> body_tick_;  // newest sample of each body in the tick being noted
  bool waiting_ = false;         // the worker sleeps until there is room
  bool link_lost_ = false;
  std::uint64_t link_losses_ = 0;
};

}  // namespace limbcast::gateway
