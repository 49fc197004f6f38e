#pragma once

#include <functional>
#include <string>
#include <thread>

namespace limbcast::runtime {

/// Names the calling thread as `top -H` and a debugger show it; the kernel keeps 15 characters.
void SetThisThreadName(const std::string& name);

/// A named thread that is joined when it goes out of scope. `body` must return when its owner tells
/// it to (a WakeEvent, a Sleeper). SIGINT and SIGTERM are blocked in it, so that a signal never
/// interrupts a worker; its timers run with 1 µs slack.
class NamedThread {
 public:
  NamedThread() = default;
  NamedThread(std::string name, std::function<void()> body);
  NamedThread(NamedThread&&) = default;
  NamedThread& operator=(NamedThread&& other) noexcept;
  NamedThread(const NamedThread&) = delete;
  NamedThread& operator=(const NamedThread&) = delete;
  ~NamedThread();

  /// Waits for the end of `body`. Idempotent. Not from inside `body`.
  void Join();
  [[nodiscard]] bool joinable() const { return thread_.joinable(); }

 private:
  std::thread thread_;
};

}  // namespace limbcast::runtime
