#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/bus/bus.hpp"

namespace limbcast::conformance {

/// A writer of Examples on a topic chosen by name. Thread-safe.
class TopicWriter {
 public:
  virtual ~TopicWriter() = default;
  [[nodiscard]] virtual Status Write(std::uint32_t key, std::uint32_t sequence) = 0;
  [[nodiscard]] virtual Status Dispose(std::uint32_t key) = 0;
  [[nodiscard]] virtual bus::EndpointCounters counters() const = 0;
};

/// `topic` is the short name of a topic; kNotFound when there is none.
[[nodiscard]] Result<std::unique_ptr<TopicWriter>> MakeTopicWriter(bus::Bus& bus,
                                                                   std::string_view topic);

/// What a raw writer needs to pretend that it carries a topic.
struct TopicNames {
  std::string topic;
  std::string type;
  bus::QosProfile profile = bus::QosProfile::kStream;
  bool exclusive = false;
};
[[nodiscard]] Result<TopicNames> NamesOf(std::string_view topic);

using Bytes = std::vector<std::uint8_t>;

/// The instance that garbage belongs to, as far as one can tell.
inline constexpr std::uint32_t kGarbageKey = 1777;

/// Payloads under the name of `topic` that no reader may hand on, and every reader must count: cut
/// off, without a body, too long, with lengths beyond their bounds, with numbers that are no
/// enumerator.
[[nodiscard]] std::vector<Bytes> Garbage(std::string_view topic);

/// Payloads whose encapsulation is none. No reader may hand them on; Cyclone DDS itself refuses
/// them and their writer, before any of our code could count.
[[nodiscard]] std::vector<Bytes> BadEncapsulations(std::string_view topic);

}  // namespace limbcast::conformance
