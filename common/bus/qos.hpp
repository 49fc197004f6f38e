#pragma once

#include <cstdint>

namespace limbcast::bus {

/// Quality of service by purpose; each DDS back end maps it once, explicitly, to its own policies.
enum class QosProfile : std::uint8_t {
  /// Samples of a moving thing: RELIABLE (a lost packet is repeated), KEEP_LAST(16) for each
  /// instance, VOLATILE. A slow
  /// reader loses old samples and never holds the writer back.
  kStream,
  /// What is true until it changes: RELIABLE, TRANSIENT_LOCAL, KEEP_LAST(1). A late joiner gets the
  /// last value.
  kState,
  /// Requests and replies: RELIABLE, VOLATILE, KEEP_ALL within limits.
  kCommand,
};

}  // namespace limbcast::bus
