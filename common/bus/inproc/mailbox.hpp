#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <thread>
#include <unordered_set>
#include <utility>

#include "common/base/expects.hpp"
#include "common/bus/endpoint_events.hpp"
#include "common/bus/reader.hpp"
#include "common/bus/wire/codec.hpp"

namespace limbcast::bus::inproc {

/// Runs one reader's handler, one call at a time, on the thread that delivers. A delivery that
/// finds the handler running (another thread, or a handler that writes to its own topic) leaves a
/// copy, which the running thread handles next: nothing deadlocks and order is kept. Thread-safe.
template <typename T>
class Mailbox {
 public:
  Mailbox(ReaderHandler<T> handler, EndpointEvents& events)
      : handler_(std::move(handler)), events_(events) {}

  void Sample(const T& value, const SampleInfo& info) { Deliver(value, info, false); }
  void Disposed(const T& key) { Deliver(key, {}, true); }

  /// Deliveries only queue from now on until Release, so that what a late joiner missed comes
  /// first.
  void Hold() {
    const std::scoped_lock lock(mutex_);
    running_ = true;
  }
  /// Handles what has queued, on this thread.
  void Release() {
    std::unique_lock lock(mutex_);
    Drain(lock);
  }

  /// Waits for a running call; no call starts afterwards. Not from inside the handler.
  void Close() {
    std::unique_lock lock(mutex_);
    Expects(!running_ || runner_ != std::this_thread::get_id(),
            "a reader destroyed outside its own handler");
    closed_ = true;
    queue_.clear();
    idle_.wait(lock, [this] { return !running_; });
  }

 private:
  // A handler this far behind several writers loses the oldest, like a full DDS history.
  static constexpr std::size_t kMaxQueued = 65536;

  struct Item {
    T value;
    SampleInfo info;
    bool disposed;
  };

  void Deliver(const T& value, const SampleInfo& info, bool disposed) {
    std::unique_lock lock(mutex_);
    if (closed_) {
      return;
    }
    if (running_) {
      queue_.push_back({value, info, disposed});
      if (queue_.size() > kMaxQueued) {
        queue_.pop_front();
        lock.unlock();
        events_.Lost(1);
      }
      return;
    }
    running_ = true;
    runner_ = std::this_thread::get_id();
    lock.unlock();
    Handle(value, info, disposed);
    lock.lock();
    Drain(lock);
  }

  void Drain(std::unique_lock<std::mutex>& lock) {
    runner_ = std::this_thread::get_id();
    while (!queue_.empty()) {
      const Item item = std::move(queue_.front());
      queue_.pop_front();
      lock.unlock();
      Handle(item.value, item.info, item.disposed);
      lock.lock();
    }
    running_ = false;
    idle_.notify_all();
  }

  void Handle(const T& value, const SampleInfo& info, bool disposed) {
    const InstanceKey key = Codec<T>::Key(value);
    if (disposed) {
      if (known_.erase(key) == 0) {
        return;  // what was never heard of is nobody's business
      }
      events_.Disposed();
      if (handler_.on_disposed) {
        handler_.on_disposed(value);
      }
    } else {
      known_.insert(key);
      events_.Sample();
      if (handler_.on_sample) {
        handler_.on_sample(value, info);
      }
    }
  }

  const ReaderHandler<T> handler_;
  EndpointEvents& events_;
  std::unordered_set<InstanceKey> known_;  // instances heard of; used by the running call only
  std::mutex mutex_;                       // guards what follows; never held while the handler runs
  std::condition_variable idle_;
  std::deque<Item> queue_;
  bool running_ = false;
  bool closed_ = false;
  std::thread::id runner_;
};

}  // namespace limbcast::bus::inproc
