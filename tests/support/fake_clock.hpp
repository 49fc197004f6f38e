#pragma once

#include <atomic>
#include <cstdint>

#include "common/base/clock.hpp"

namespace limbcast::test_support {

/// A clock that stands still until a test moves it. Thread-safe.
class FakeClock final : public Clock {
 public:
  explicit FakeClock(Time start = TimeFromNanoseconds(1'700'000'000'000'000'000))
      : now_ns_(ToNanoseconds(start)) {}
  [[nodiscard]] Time Now() const override { return TimeFromNanoseconds(now_ns_.load()); }
  void Advance(Duration by) { now_ns_ += by.count(); }
  void Set(Time now) { now_ns_ = ToNanoseconds(now); }

 private:
  std::atomic<std::int64_t> now_ns_;
};

}  // namespace limbcast::test_support
