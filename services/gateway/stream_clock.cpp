#include "services/gateway/stream_clock.hpp"

#include <algorithm>
#include <cmath>

namespace limbcast::gateway {

namespace {
constexpr int kCatchUp = 4;  // times the speed
}  // namespace

Duration StreamClock::Scaled(Duration recording) const {
  return pace_.speed == 1.0
             ? recording
             : Duration{std::llround(static_cast<double>(recording.count()) / pace_.speed)};
}

void StreamClock::Start(Time first, Time now) {
  to_stream_ = now - first;
  last_ = first;
  last_due_ = now;
  last_sent_ = now;
  sent_ = false;
  lag_ = Duration{};
}

void StreamClock::Loop(Time first, Duration period) {
  const Time next = last_ + period;  // where `first` would be, had the recording gone on
  to_stream_ += next - first;
  last_ = first - period;
}

Time StreamClock::DueAt(Time recording, Time now) const {
  if (pace_.as_fast) {
    return now;
  }
  const Duration step = Scaled(recording - last_);
  const Time due = last_due_ + step;
  if (!sent_) {
    return due;
  }
  if (due - now > step + kMaxLag) {  // the clock was set back
    return now;
  }
  return std::max(due, last_sent_ + step / kCatchUp);
}

Time StreamClock::DueInRealTime(Time recording) const { return last_sent_ + (recording - last_); }

bool StreamClock::Send(Time recording, Time now) {
  Time due = pace_.as_fast ? now : last_due_ + Scaled(recording - last_);
  lag_ = now - due;
  const bool jumps = lag_ > kMaxLag || lag_ < -kMaxLag;
  if (jumps) {
    to_stream_ += lag_;
    due = now;
    lag_ = Duration{};
  }
  last_ = recording;
  last_due_ = due;
  last_sent_ = now;
  sent_ = true;
  return jumps;
}

}  // namespace limbcast::gateway
