#pragma once

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "common/bus/bus_config.hpp"
#include "common/bus/events.hpp"

namespace limbcast::bus::testing {

/// A domain that no other test of this machine uses now: a name bound to this process says so.
inline std::uint32_t TestDomain() {
  constexpr std::uint32_t kDomains = 102;
  static const std::uint32_t domain = [] {
    const auto first = static_cast<std::uint32_t>(getpid());
    for (std::uint32_t i = 0; i < kDomains; ++i) {
      const std::uint32_t candidate = (first + i) % kDomains;
      const std::string name = "limbcast-test-domain-" + std::to_string(candidate);
      sockaddr_un address{};
      address.sun_family = AF_UNIX;  // the first byte of the path stays 0: an abstract name
      name.copy(&address.sun_path[1], name.size());
      const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
      const int fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
      // NOLINTNEXTLINE(*-reinterpret-cast): the interface of bind
      if (bind(fd, reinterpret_cast<const sockaddr*>(&address), size) == 0) {
        return candidate;  // the socket stays open as long as the process
      }
      close(fd);
    }
    return first % kDomains;
  }();
  return domain;
}

/// In a partition of this process: on a domain that is in use after all, nobody is met by mistake.
inline BusConfig LoopbackConfig(Vendor vendor) {
  BusConfig config;
  config.vendor = vendor;
  config.domain_id = TestDomain();
  config.partition = "unit-test-" + std::to_string(getpid());
  config.participant_name = "limbcast-unit-test";
  return config;
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
