#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "common/runtime/named_thread.hpp"
#include "common/runtime/wake_event.hpp"
#include "common/runtime/worker_pool.hpp"

namespace limbcast::runtime {

struct ThreadPoolConfig {
  /// Threads are named "<name>-0", "<name>-1", ...; the kernel keeps 15 characters.
  std::string name = "worker";

  /// Range: [1, 64].
  std::size_t workers = 1;

  /// A worker that ran out of work looks for more this long before it sleeps. Saves the wake-up of
  /// a thread (some 10 µs) for a core that does nothing else; harmful when cores are shared. Zero:
  /// off. Range: [0, 1 ms].
  Duration spin = Duration::zero();
};

/// WorkerPool on threads: one for each worker, asleep on a futex between drains. Wake is one atomic
/// exchange when its worker is awake, and one system call more when it sleeps. The wish of a drain
/// (Time) is taken on the host's CLOCK_REALTIME.
class ThreadPool final : public WorkerPool {
 public:
  explicit ThreadPool(ThreadPoolConfig config);
  ThreadPool(std::string name, std::size_t workers)
      : ThreadPool(ThreadPoolConfig{std::move(name), workers, Duration::zero()}) {}
  ~ThreadPool() override;
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  [[nodiscard]] std::size_t size() const override { return workers_.size(); }
  void Start(Drain drain) override;
  void Wake(std::size_t worker) override;
  void Stop() override;

 private:
  // On a cache line of its own: producers write here while other workers run.
  struct alignas(64) Worker {
    WakeEvent event;
    NamedThread thread;
  };
  void Run(std::size_t index);
  void Spin(const WakeEvent& event) const;

  const ThreadPoolConfig config_;
  std::vector<std::unique_ptr<Worker>> workers_;
  Drain drain_;
};

}  // namespace limbcast::runtime
