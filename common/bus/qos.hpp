#pragma once

#include <cstdint>

namespace limbcast::bus {

/// Quality of service by purpose; each DDS back end maps it once, explicitly, to its own policies.
enum class QosProfile : std::uint8_t {
  /// Samples of a moving thing: RELIABLE (a lost packet is repeated), KEEP_LAST(16) for each
  /// instance, VOLATILE. A slow
  /// reader loses old samples and never holds the writer back.
  kStream,
  /// A stream whose samples carry all of a body and tick, a few kilobytes each: a writer keeps
  /// FrameDepth of them. They are most of what a service holds for a person.
  kFrame,
  /// What is true until it changes: RELIABLE, TRANSIENT_LOCAL, KEEP_LAST(1). A late joiner gets the
  /// last value. Readers keep the last 8 (kStateReaderDepth).
  kState,
  /// Requests and replies: RELIABLE, VOLATILE, KEEP_ALL within limits.
  kCommand,
};

/// How many untaken samples of an instance a reader of a state topic keeps. More than one, because
/// two writers may have one instance (a service and the one that stands by for it): with one, what
/// comes second takes the first one's place before it is read, and Fast DDS drops what comes second
/// but was written before.
inline constexpr int kStateReaderDepth = 8;

/// Of BusConfig::stream_depth, what a writer of frames keeps: 80 ms at 100 Hz with the default
/// of 16. A lost packet is known with the next one, asked for 2 ms later and repeated at once.
[[nodiscard]] constexpr int FrameDepth(int stream_depth) {
  return stream_depth > 1 ? stream_depth / 2 : 1;
}

}  // namespace limbcast::bus
