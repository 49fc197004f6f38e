#include "common/runtime/wake_event.hpp"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>

namespace limbcast::runtime {

static_assert(std::atomic<std::uint32_t>::is_always_lock_free);
static_assert(sizeof(std::atomic<std::uint32_t>) == sizeof(std::uint32_t));

namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

// The C library has no wrapper for futex(2). Absolute deadlines need the BITSET form.
int WaitOnFutex(std::atomic<std::uint32_t>* word, std::uint32_t expected, int clock_flag,
                const timespec* deadline) {
  const int saved = errno;
  const long rc = syscall(SYS_futex, word, FUTEX_WAIT_BITSET | FUTEX_PRIVATE_FLAG | clock_flag,
                          expected, deadline, nullptr, FUTEX_BITSET_MATCH_ANY);
  const int error = rc == 0 ? 0 : errno;
  errno = saved;
  return error;
}

void WakeFutex(std::atomic<std::uint32_t>* word) {
  const int saved = errno;  // Set may run in a signal handler
  syscall(SYS_futex, word, FUTEX_WAKE | FUTEX_PRIVATE_FLAG, 1, nullptr, nullptr, 0);
  errno = saved;
}

}  // namespace

void WakeEvent::Set() {
  std::uint32_t old = state_.load(std::memory_order_relaxed);
  // Always a read-modify-write, also when it is set already: it orders what the caller queued
  // before the wait that consumes it.
  do {
    if (old == kClosed) {
      return;
    }
  } while (!state_.compare_exchange_weak(old, kSet, std::memory_order_acq_rel,
                                         std::memory_order_acquire));
  if (old == kSleeping) {
    WakeFutex(&state_);
  }
}

void WakeEvent::Close() {
  if (state_.exchange(kClosed, std::memory_order_acq_rel) == kSleeping) {
    WakeFutex(&state_);
  }
}

bool WakeEvent::Consume() {
  std::uint32_t old = state_.load(std::memory_order_acquire);
  while (old != kClosed) {
    if (state_.compare_exchange_weak(old, kIdle, std::memory_order_acq_rel,
                                     std::memory_order_acquire)) {
      return old == kSet;
    }
  }
  return true;
}

bool WakeEvent::Wait(int clock_flag, std::optional<std::int64_t> deadline_ns) {
  timespec deadline{};
  if (deadline_ns) {
    const std::int64_t clamped = *deadline_ns > 0 ? *deadline_ns : 0;
    deadline.tv_sec = clamped / kNanosecondsPerSecond;
    deadline.tv_nsec = clamped % kNanosecondsPerSecond;
  }
  while (!Consume()) {
    std::uint32_t expected = kIdle;
    if (!state_.compare_exchange_strong(expected, kSleeping, std::memory_order_acq_rel)) {
      continue;  // set or closed in between
    }
    const int error =
        WaitOnFutex(&state_, kSleeping, clock_flag, deadline_ns ? &deadline : nullptr);
    if (error == ETIMEDOUT) {
      return Consume();
    }
  }
  return true;
}

bool WakeEvent::WaitUntil(std::optional<Time> deadline) {
  return Wait(FUTEX_CLOCK_REALTIME,
              deadline ? std::optional(ToNanoseconds(*deadline)) : std::nullopt);
}

bool WakeEvent::WaitFor(Duration span) {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return Wait(0, static_cast<std::int64_t>(now.tv_sec) * kNanosecondsPerSecond + now.tv_nsec +
                     span.count());
}

}  // namespace limbcast::runtime
