#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/bus/events.hpp"
#include "common/bus/reader.hpp"
#include "tests/support/topic_examples.hpp"

namespace limbcast::conformance {

/// However long a busy machine may take; a test that passes never waits for it.
inline constexpr std::chrono::seconds kDeadline{20};

/// The instance that Connect uses to see data flow; left out of what a test looks at.
inline constexpr std::uint32_t kWarmUpKey = 1999;

struct Received {
  std::uint32_t key = 0;
  std::uint32_t sequence = 0;
  bool intact = false;
  std::chrono::steady_clock::time_point at;
};

/// Remembers what a reader of Examples got. Thread-safe. Outlives the reader.
template <typename T>
class Collector {
 public:
  [[nodiscard]] bus::ReaderHandler<T> Handler() {
    return {.on_sample = [this](const T& value, const bus::SampleInfo&) { Add(value); },
            .on_disposed =
                [this](const T& key) {
                  const std::lock_guard lock(mutex_);
                  disposed_.push_back(test_support::ExampleKey(key));
                  changed_.notify_all();
                }};
  }

  /// From now on the handler does not return until Open; a call that is inside waits, too.
  void Shut() {
    const std::lock_guard lock(mutex_);
    shut_ = true;
  }
  void Open() {
    const std::lock_guard lock(mutex_);
    shut_ = false;
    changed_.notify_all();
  }

  /// Waits until `holds(received samples, disposed keys)`; false after kDeadline.
  template <typename Predicate>
  [[nodiscard]] bool WaitUntil(Predicate holds) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kDeadline, [&] { return holds(received_, disposed_); });
  }
  [[nodiscard]] bool WaitForCount(std::size_t count) {
    return WaitUntil([&](const auto& received, const auto&) { return received.size() >= count; });
  }
  [[nodiscard]] bool WaitForSample(std::uint32_t key, std::uint32_t sequence) {
    return WaitUntil([&](const auto& received, const auto&) {
      return std::any_of(received.begin(), received.end(), [&](const Received& sample) {
        return sample.key == key && sample.sequence == sequence;
      });
    });
  }
  [[nodiscard]] bool WaitForWarmUp(std::size_t more_than) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kDeadline, [&] { return warm_ups_ > more_than; });
  }
  [[nodiscard]] std::size_t warm_ups() const {
    const std::lock_guard lock(mutex_);
    return warm_ups_;
  }
  [[nodiscard]] std::vector<Received> received() const {
    const std::lock_guard lock(mutex_);
    return received_;
  }
  [[nodiscard]] std::vector<std::uint32_t> disposed() const {
    const std::lock_guard lock(mutex_);
    return disposed_;
  }
  /// The sequence numbers of one instance in the order of arrival.
  [[nodiscard]] std::vector<std::uint32_t> SequencesOf(std::uint32_t key) const {
    const std::lock_guard lock(mutex_);
    std::vector<std::uint32_t> sequences;
    for (const Received& sample : received_) {
      if (sample.key == key) {
        sequences.push_back(sample.sequence);
      }
    }
    return sequences;
  }
  [[nodiscard]] bool AllIntact() const {
    const std::lock_guard lock(mutex_);
    return std::all_of(received_.begin(), received_.end(),
                       [](const Received& sample) { return sample.intact; });
  }

 private:
  void Add(const T& value) {
    const Received sample{.key = test_support::ExampleKey(value),
                          .sequence = test_support::ExampleSequence(value),
                          .intact = test_support::IsIntact(value),
                          .at = std::chrono::steady_clock::now()};
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !shut_; });
    if (sample.key == kWarmUpKey) {
      ++warm_ups_;
    } else {
      received_.push_back(sample);
    }
    changed_.notify_all();
  }

  mutable std::mutex mutex_;  // guards the rest
  std::condition_variable changed_;
  bool shut_ = false;
  std::size_t warm_ups_ = 0;
  std::vector<Received> received_;
  std::vector<std::uint32_t> disposed_;
};

/// Remembers the events of a bus. Thread-safe. Outlives the bus.
class EventLog {
 public:
  [[nodiscard]] bus::BusEventHandler Handler() {
    return [this](const bus::BusEvent& event) {
      std::unique_lock lock(mutex_);
      events_.emplace_back(event, std::chrono::steady_clock::now());
      changed_.notify_all();
      changed_.wait(lock, [&] { return event.kind != held_; });
    };
  }

  /// From now on the handler does not return from an event of that kind until Release.
  void Hold(bus::BusEventKind kind) {
    const std::lock_guard lock(mutex_);
    held_ = kind;
  }
  void Release() {
    const std::lock_guard lock(mutex_);
    held_.reset();
    changed_.notify_all();
  }
  [[nodiscard]] std::size_t size() const {
    const std::lock_guard lock(mutex_);
    return events_.size();
  }
  /// Waits for an event of that kind and topic among those from number `from` on; false after
  /// `deadline`.
  [[nodiscard]] bool WaitFor(bus::BusEventKind kind, std::string_view topic, std::size_t from = 0,
                             std::chrono::milliseconds deadline = kDeadline) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, deadline, [&] { return Find(kind, topic, from) != nullptr; });
  }
  /// The same for one with that detail; a stranger on the same domain may cause others.
  [[nodiscard]] bool WaitForDetail(bus::BusEventKind kind, std::string_view topic,
                                   std::string_view detail) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kDeadline,
                             [&] { return Find(kind, topic, 0, detail) != nullptr; });
  }
  /// The first such event and when it came; WaitFor has seen it.
  [[nodiscard]] std::pair<bus::BusEvent, std::chrono::steady_clock::time_point> Get(
      bus::BusEventKind kind, std::string_view topic, std::size_t from = 0) const {
    const std::lock_guard lock(mutex_);
    const Entry* entry = Find(kind, topic, from);
    return entry == nullptr ? Entry{} : *entry;
  }

 private:
  using Entry = std::pair<bus::BusEvent, std::chrono::steady_clock::time_point>;

  [[nodiscard]] const Entry* Find(bus::BusEventKind kind, std::string_view topic, std::size_t from,
                                  std::optional<std::string_view> detail = {}) const {
    for (std::size_t i = from; i < events_.size(); ++i) {
      const bus::BusEvent& event = events_[i].first;
      if (event.kind == kind && event.topic == topic && (!detail || event.detail == *detail)) {
        return &events_[i];
      }
    }
    return nullptr;
  }

  mutable std::mutex mutex_;  // guards the rest
  std::condition_variable changed_;
  std::optional<bus::BusEventKind> held_;
  std::vector<Entry> events_;
};

}  // namespace limbcast::conformance
