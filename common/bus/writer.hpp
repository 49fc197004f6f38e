#pragma once

#include "common/base/result.hpp"
#include "common/bus/endpoint.hpp"

namespace limbcast::bus {

/// Publishes values of T on its topic. Thread-safe. Destroying it leaves the network; values of
/// state topics stay with readers until they are disposed.
template <typename T>
class Writer {
 public:
  virtual ~Writer() = default;

  /// Hands `value` to the middleware; it may still sit in a batch until Flush. Fails when a bound
  /// of the wire type is exceeded (kInvalidArgument, naming the field) or the middleware refuses
  /// (kTimeout, kUnavailable).
  [[nodiscard]] virtual Status Write(const T& value) = 0;

  /// The instance of `key` (only its key fields count) is gone for good: readers get on_disposed.
  [[nodiscard]] virtual Status Dispose(const T& key) = 0;

  /// Sends what batching still holds. Does nothing without batching.
  virtual void Flush() = 0;

  [[nodiscard]] virtual EndpointCounters counters() const = 0;
};

}  // namespace limbcast::bus
