#pragma once

#include <functional>
#include <memory>
#include <span>
#include <utility>

#include "common/bus/bus.hpp"

namespace limbcast::bus {

/// Hears segment states whichever way their service publishes them: each alone (`segment_state`) or
/// those of a body in one message (`segment_frame`).
class SegmentStateReader {
 public:
  /// Gets one state or those of a frame, all of one body. The two ways call it on their own
  /// threads, so it must be thread-safe.
  using Handler = std::function<void(std::span<const body::SegmentState>, const SampleInfo&)>;

  /// Fails when the bus does. `bus` outlives it.
  [[nodiscard]] static Result<std::unique_ptr<SegmentStateReader>> Make(Bus& bus, Handler handler) {
    std::unique_ptr<SegmentStateReader> made(new SegmentStateReader(std::move(handler)));
    auto single = bus.MakeReader<body::SegmentState>(
        {.on_sample =
             [self = made.get()](const body::SegmentState& state, const SampleInfo& info) {
               self->handler_({&state, 1}, info);
             },
         .on_disposed = {}});
    if (!single) {
      return single.error();
    }
    auto frames = bus.MakeReader<body::SegmentFrame>(
        {.on_sample = [self = made.get()](
                          const body::SegmentFrame& frame,
                          const SampleInfo& info) { self->handler_(frame.states, info); },
         .on_disposed = {}});
    if (!frames) {
      return frames.error();
    }
    made->single_ = std::move(*single);
    made->frames_ = std::move(*frames);
    return made;
  }

  /// Of both ways.
  [[nodiscard]] int alive_writers() const {
    return single_->counters().alive_writers + frames_->counters().alive_writers;
  }
  /// Messages of both ways, as told by the middleware.
  [[nodiscard]] std::uint64_t lost() const {
    return single_->counters().lost + frames_->counters().lost;
  }

 private:
  explicit SegmentStateReader(Handler handler) : handler_(std::move(handler)) {}

  const Handler handler_;
  std::unique_ptr<Reader<body::SegmentState>> single_;
  std::unique_ptr<Reader<body::SegmentFrame>> frames_;
};

}  // namespace limbcast::bus
