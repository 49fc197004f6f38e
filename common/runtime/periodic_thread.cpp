#include "common/runtime/periodic_thread.hpp"

#include <chrono>
#include <utility>

#include "common/base/expects.hpp"

namespace limbcast::runtime {

PeriodicThread::PeriodicThread(std::string name, Duration period, std::function<void()> tick)
    : period_(period), tick_(std::move(tick)) {
  Expects(period_ > Duration::zero(), "a positive period");
  thread_ = NamedThread(std::move(name), [this] { Run(); });
}

void PeriodicThread::Stop() {
  sleeper_.Stop();
  thread_.Join();
}

void PeriodicThread::Run() {
  using SteadyTime = std::chrono::steady_clock::time_point;
  SteadyTime next = std::chrono::steady_clock::now() + period_;
  while (sleeper_.For(next - std::chrono::steady_clock::now())) {
    tick_();
    ++ticks_;
    next += period_;
    const SteadyTime now = std::chrono::steady_clock::now();
    if (next < now) {
      const auto missed = (now - next) / period_ + 1;
      missed_ticks_ += static_cast<std::uint64_t>(missed);
      next += missed * period_;
    }
  }
}

}  // namespace limbcast::runtime
