#pragma once

#include "common/base/time.hpp"

namespace limbcast::gateway {

/// How fast a recording plays.
struct Pace {
  /// Recording seconds in each second. Range: [0.01, 1000]. Does not count when as_fast.
  double speed = 1.0;
  /// As fast as the pipeline takes it.
  bool as_fast = false;
};

/// Two mappings of recording time. *Stream time* is what samples say (`measured_at`): the start and
/// then the recording's own spacing, so that filters see the true time between samples at any
/// speed. *Due time* is when a tick is sent: the same at speed 1, else compressed or stretched. A
/// recording played faster than real time therefore runs ahead of the clock, a slower one behind.
///
/// A late sender catches up at four times the speed and not in one burst, which would overrun the
/// short histories downstream. More than kMaxLag late (the process was suspended, or the clock was
/// set) it does not catch up: it goes on from now and the stream time jumps with it.
/// Thread-compatible; reads no clock.
class StreamClock {
 public:
  static constexpr Duration kMaxLag = std::chrono::seconds(1);

  explicit StreamClock(Pace pace) : pace_(pace) {}

  /// Recording time `first` is true at `now`, and due then.
  void Start(Time first, Time now);

  /// The recording begins again: `first` follows one `period` after the last tick.
  void Loop(Time first, Duration period);

  /// Stream time of a sample.
  [[nodiscard]] Time ToStream(Time recording) const { return recording + to_stream_; }

  /// When the tick at `recording` is to be sent. As fast as possible: at once, `now`.
  [[nodiscard]] Time DueAt(Time recording, Time now) const;

  /// Tells that the tick at `recording` is sent `now`; true when the stream jumped because it was
  /// too late. Call before mapping the tick's samples.
  bool Send(Time recording, Time now);

  /// As DueAt at speed 1, whatever the pace: for a pipeline that does not answer.
  [[nodiscard]] Time DueInRealTime(Time recording) const;

  /// How late the last tick was sent; zero when as fast as possible.
  [[nodiscard]] Duration lag() const { return lag_; }

 private:
  [[nodiscard]] Duration Scaled(Duration recording) const;

  Pace pace_;
  Duration to_stream_{};  // stream − recording
  Time last_{};           // recording time of the last tick sent
  Time last_due_{};       // when that was due
  Time last_sent_{};      // and when it was sent
  bool sent_ = false;
  Duration lag_{};
};

}  // namespace limbcast::gateway
