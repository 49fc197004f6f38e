#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "common/base/time.hpp"

namespace limbcast::runtime {

/// A fixed set of workers that services give their queued work to. The service owns one queue for
/// each worker; its reader callbacks enqueue and call Wake. Implementations: ThreadPool (threads),
/// and tests/support/ImmediatePool (runs inline, time by hand).
class WorkerPool {
 public:
  virtual ~WorkerPool() = default;

  /// Does all work queued for `worker` and whatever is due, and returns when it wants to be called
  /// next even if nobody wakes it (nothing = only when woken). Never called concurrently with
  /// itself for one worker.
  using Drain = std::function<std::optional<Time>(std::size_t worker)>;

  [[nodiscard]] virtual std::size_t size() const = 0;

  /// Starts the workers. Called once.
  virtual void Start(Drain drain) = 0;

  /// Makes `worker` run its drain soon. Cheap when it is already awake; callable from any thread;
  /// takes no lock that a drain holds. Calls before Start are remembered.
  virtual void Wake(std::size_t worker) = 0;

  /// Ends the workers after a last drain each, and joins them. Idempotent.
  virtual void Stop() = 0;
};

}  // namespace limbcast::runtime
