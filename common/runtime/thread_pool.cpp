#include "common/runtime/thread_pool.hpp"

#include <chrono>
#include <thread>
#include <utility>

#include "common/base/expects.hpp"

namespace limbcast::runtime {

ThreadPool::ThreadPool(ThreadPoolConfig config) : config_(std::move(config)) {
  Expects(config_.workers >= 1 && config_.workers <= 64, "1 to 64 workers");
  workers_.reserve(config_.workers);
  for (std::size_t i = 0; i < config_.workers; ++i) {
    workers_.push_back(std::make_unique<Worker>());
  }
}

ThreadPool::~ThreadPool() { Stop(); }

void ThreadPool::Start(Drain drain) {
  Expects(!drain_, "a pool is started once");
  Expects(drain != nullptr, "a drain");
  drain_ = std::move(drain);
  for (std::size_t i = 0; i < workers_.size(); ++i) {
    workers_[i]->thread =
        NamedThread(config_.name + "-" + std::to_string(i), [this, i] { Run(i); });
  }
}

void ThreadPool::Wake(std::size_t worker) {
  Expects(worker < workers_.size(), "a worker of this pool");
  workers_[worker]->event.Set();
}

void ThreadPool::Stop() {
  for (const auto& worker : workers_) {
    worker->event.Close();
  }
  for (const auto& worker : workers_) {
    worker->thread.Join();
  }
}

void ThreadPool::Spin(const WakeEvent& event) const {
  const auto end = std::chrono::steady_clock::now() + config_.spin;
  while (!event.pending() && std::chrono::steady_clock::now() < end) {
    std::this_thread::yield();
  }
}

void ThreadPool::Run(std::size_t index) {
  WakeEvent& event = workers_[index]->event;
  while (!event.closed()) {
    const std::optional<Time> next = drain_(index);
    if (config_.spin > Duration::zero()) {
      Spin(event);
    }
    event.WaitUntil(next);
  }
  drain_(index);  // what was queued before Stop
}

}  // namespace limbcast::runtime
