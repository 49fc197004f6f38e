#include "common/runtime/stop_signal.hpp"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <climits>
#include <ctime>

#include "common/base/expects.hpp"

namespace limbcast::runtime {

namespace {

std::atomic<std::uint32_t> g_requests{0};  // only grows; a StopSignal remembers where it began
std::atomic<bool> g_in_use{false};
static_assert(std::atomic<std::uint32_t>::is_always_lock_free);

void Request() {
  g_requests.fetch_add(1, std::memory_order_acq_rel);
  syscall(SYS_futex, &g_requests, FUTEX_WAKE | FUTEX_PRIVATE_FLAG, INT_MAX, nullptr, nullptr, 0);
}

extern "C" void HandleStopSignal(int /*signal*/) {
  const int saved = errno;
  Request();
  errno = saved;
}

}  // namespace

StopSignal::StopSignal() : requests_before_(g_requests.load(std::memory_order_acquire)) {
  Expects(!g_in_use.exchange(true), "one StopSignal at a time");
  struct sigaction action {};
  action.sa_handler = &HandleStopSignal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, &previous_interrupt_);
  sigaction(SIGTERM, &action, &previous_terminate_);
}

StopSignal::~StopSignal() {
  sigaction(SIGINT, &previous_interrupt_, nullptr);
  sigaction(SIGTERM, &previous_terminate_, nullptr);
  g_in_use.store(false);
}

bool StopSignal::Requested() const {
  return g_requests.load(std::memory_order_acquire) != requests_before_;
}

void StopSignal::Trigger() { Request(); }

void StopSignal::Wait() const {
  while (!Requested()) {
    syscall(SYS_futex, &g_requests, FUTEX_WAIT | FUTEX_PRIVATE_FLAG, requests_before_, nullptr,
            nullptr, 0);
  }
}

bool StopSignal::WaitFor(Duration span) const {
  const auto deadline = std::chrono::steady_clock::now() + span;
  while (!Requested()) {
    const Duration left = deadline - std::chrono::steady_clock::now();
    if (left <= Duration::zero()) {
      return false;
    }
    timespec timeout{};
    timeout.tv_sec = left.count() / 1'000'000'000;
    timeout.tv_nsec = left.count() % 1'000'000'000;
    syscall(SYS_futex, &g_requests, FUTEX_WAIT | FUTEX_PRIVATE_FLAG, requests_before_, &timeout,
            nullptr, 0);
  }
  return true;
}

}  // namespace limbcast::runtime
