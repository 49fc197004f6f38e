#pragma once

#include <cstdint>
#include <memory>

#include "common/base/ids.hpp"
#include "common/base/result.hpp"
#include "common/body/segment_frame.hpp"
#include "common/body/segment_state.hpp"
#include "common/bus/bus.hpp"
#include "services/fusion/fusion_counters.hpp"

namespace limbcast::fusion {

/// The way out of fusion, shared by the workers: each state alone, or those of a body and a round
/// in one message. One of the two writers is there. Thread-safe.
struct StateWriters {
  std::unique_ptr<bus::Writer<body::SegmentState>> single;
  std::unique_ptr<bus::Writer<body::SegmentFrame>> frames;

  [[nodiscard]] static Result<StateWriters> Make(bus::Bus& bus, bool frames);
  /// Who hears them now; 0 before Make.
  [[nodiscard]] std::int32_t readers() const;
};

/// One worker's states on their way out. Thread-compatible; does not allocate after construction.
class StatePublisher {
 public:
  /// What is referred to outlives it. `counters` get every state once: published or not.
  StatePublisher(StateWriters& writers, CounterCells& counters);

  /// Sends now, or with the next ones of the same body: at the latest in Flush.
  void Write(const body::SegmentState& state);
  /// The segment and slot of `key` have no state any more.
  void Dispose(const body::SegmentState& key);
  /// Nor has any segment of the body. After Dispose of each.
  void DisposeBody(BodyId body_id);
  void Flush();

 private:
  void Send();

  StateWriters& writers_;
  CounterCells& counters_;
  body::SegmentFrame frame_;  // not yet sent
};

}  // namespace limbcast::fusion
