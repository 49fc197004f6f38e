#pragma once

#include <cstdint>
#include <functional>

#include "common/base/time.hpp"
#include "common/bus/endpoint.hpp"

namespace limbcast::bus {

/// How a sample came.
struct SampleInfo {
  Time received_at{};  ///< when the middleware handed it over, system clock (read once for each
                       ///< take)
};

/// What a reader does with what it gets. Called on a middleware thread (inproc: on the writing
/// thread), one call at a time for each reader: enqueue and return, a slow handler delays every
/// reader of the process.
template <typename T>
struct ReaderHandler {
  /// `value` lives only during the call; its containers are reused, so copy what is kept.
  std::function<void(const T& value, const SampleInfo& info)> on_sample;
  /// An instance that on_sample told of was disposed. Only the key fields of `key` mean something.
  /// May be empty.
  std::function<void(const T& key)> on_disposed;
};

/// A subscription to the topic of T. Destroying it ends it: no handler runs after the destructor
/// returns.
template <typename T>
class Reader {
 public:
  virtual ~Reader() = default;
  [[nodiscard]] virtual EndpointCounters counters() const = 0;
};

}  // namespace limbcast::bus
