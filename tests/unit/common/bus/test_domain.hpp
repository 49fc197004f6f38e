#pragma once

#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "common/bus/bus_config.hpp"
#include "common/bus/events.hpp"

namespace limbcast::bus::testing {

/// A domain that other tests of this machine are unlikely to use now.
inline std::uint32_t TestDomain() { return static_cast<std::uint32_t>(getpid()) % 102; }

/// In a partition of this process: on a domain that is in use after all, nobody is met by mistake.
inline BusConfig LoopbackConfig(Vendor vendor) {
  return {.vendor = vendor,
          .domain_id = TestDomain(),
          .partition = "unit-test-" + std::to_string(getpid()),
          .participant_name = "limbcast-unit-test"};
}

/// Collects from middleware threads; tests wait for what they expect, never for time to pass.
template <typename T>
class Collected {
 public:
  void Add(T item) {
    const std::scoped_lock lock(mutex_);
    items_.push_back(std::move(item));
    changed_.notify_all();
  }
  /// True as soon as `condition(items)`; false when that does not come in a generous time.
  template <typename Condition>
  [[nodiscard]] bool WaitFor(Condition condition) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::seconds(20), [&] { return condition(items_); });
  }
  [[nodiscard]] bool WaitForCount(std::size_t count) {
    return WaitFor([count](const auto& items) { return items.size() >= count; });
  }
  [[nodiscard]] std::vector<T> items() {
    const std::scoped_lock lock(mutex_);
    return items_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<T> items_;
};

/// Waits for a kind of event on a topic.
class CollectedEvents : public Collected<BusEvent> {
 public:
  [[nodiscard]] BusEventHandler handler() {
    return [this](const BusEvent& event) { Add(event); };
  }
  [[nodiscard]] bool WaitForEvent(BusEventKind kind, bool from_writer) {
    return WaitFor([=](const auto& events) {
      for (const BusEvent& event : events) {
        if (event.kind == kind && event.from_writer == from_writer) {
          return true;
        }
      }
      return false;
    });
  }
};

}  // namespace limbcast::bus::testing
