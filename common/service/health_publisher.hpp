#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "common/base/clock.hpp"
#include "common/base/health.hpp"
#include "common/base/result.hpp"
#include "common/bus/bus.hpp"
#include "common/runtime/periodic_thread.hpp"

namespace limbcast::service {

/// Publishes a ServiceHealth once in a period and once more at the end: process usage and identity
/// are filled in here, values, latencies and last_error by the service. Thread-safe.
class HealthPublisher {
 public:
  /// Adds what the service knows. Called on the publisher's thread, one call at a time; must not
  /// wait for the hot path.
  using Fill = std::function<void(ServiceHealth& health)>;

  /// Draws a random process_uid. Fails when the bus does. `clock` and `bus` outlive it.
  [[nodiscard]] static Result<std::unique_ptr<HealthPublisher>> Make(std::string role,
                                                                     const Clock& clock,
                                                                     bus::Bus& bus, Fill fill);
  ~HealthPublisher() { Stop(); }
  HealthPublisher(const HealthPublisher&) = delete;
  HealthPublisher& operator=(const HealthPublisher&) = delete;

  /// Starts the thread. Tests call Publish instead.
  void Start(Duration period = std::chrono::seconds(1));

  /// Publishes a last time and ends the thread. Idempotent.
  void Stop();

  /// Publishes once, now.
  void Publish();

  /// Shown as last_error when Fill leaves that empty; "" takes it back.
  void SetLastError(std::string message);

 private:
  HealthPublisher(std::string role, const Clock& clock,
                  std::unique_ptr<bus::Writer<ServiceHealth>> writer, Fill fill);

  const Clock& clock_;
  const std::unique_ptr<bus::Writer<ServiceHealth>> writer_;
  const Fill fill_;
  std::mutex mutex_;  // guards the three below
  ServiceHealth health_;
  std::string last_error_;
  bool stopped_ = false;
  std::optional<runtime::PeriodicThread> thread_;
};

}  // namespace limbcast::service
