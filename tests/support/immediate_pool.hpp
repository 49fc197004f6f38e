#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "common/runtime/worker_pool.hpp"

namespace limbcast::test_support {

/// A WorkerPool without threads: Wake drains on the caller's thread (a Wake from inside a drain is
/// done right after it), and a test calls RunDue after moving its clock. Thread-compatible.
class ImmediatePool final : public runtime::WorkerPool {
 public:
  explicit ImmediatePool(std::size_t size = 1) : workers_(size) {}

  [[nodiscard]] std::size_t size() const override { return workers_.size(); }
  void Start(Drain drain) override {
    drain_ = std::move(drain);
    for (std::size_t i = 0; i < workers_.size(); ++i) {
      Run(i);
    }
  }
  void Wake(std::size_t worker) override {
    workers_[worker].woken = true;
    if (drain_ && !workers_[worker].running) {
      Run(worker);
    }
  }
  void Stop() override {
    for (std::size_t i = 0; drain_ && i < workers_.size(); ++i) {
      Run(i);
    }
    drain_ = nullptr;
  }

  /// Drains every worker whose wish for a next call is at or before `now`.
  void RunDue(Time now) {
    for (std::size_t i = 0; drain_ && i < workers_.size(); ++i) {
      while (workers_[i].next && *workers_[i].next <= now) {
        workers_[i].next.reset();
        Run(i);
      }
    }
  }

 private:
  struct Worker {
    bool woken = false;
    bool running = false;
    std::optional<Time> next;
  };
  void Run(std::size_t index) {
    Worker& worker = workers_[index];
    worker.running = true;
    do {
      worker.woken = false;
      worker.next = drain_(index);
    } while (worker.woken);
    worker.running = false;
  }
  std::vector<Worker> workers_;
  Drain drain_;
};

}  // namespace limbcast::test_support
