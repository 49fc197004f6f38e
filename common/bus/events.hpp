#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace limbcast::bus {

/// Things that happen to a connection and must never be silent.
enum class BusEventKind : std::uint8_t {
  kMatched,           ///< a peer endpoint appeared (count = how many now)
  kUnmatched,         ///< a peer endpoint went (count = how many now)
  kIncompatibleQos,   ///< a peer asked for another quality of service; detail = the policy
  kSampleLost,        ///< the middleware lost samples (count = how many more)
  kSampleRejected,    ///< the middleware refused samples for lack of room
  kMalformed,         ///< bytes that do not decode as this type
  kLivelinessLost,    ///< a remote writer went silent or died (count = how many alive now)
  kLivelinessGained,  ///< a remote writer is alive (again) (count = how many alive now)
  kTypeMismatch,      ///< a peer uses another type under this topic name
};
inline constexpr std::size_t kBusEventKindCount = 9;

/// Lower-snake name: "matched", "incompatible_qos", ...
[[nodiscard]] std::string_view ToString(BusEventKind kind);

struct BusEvent {
  BusEventKind kind = BusEventKind::kMatched;
  std::string_view topic;    ///< short name, e.g. "marg"; static storage
  bool from_writer = false;  ///< it happened to our writer (else to our reader)
  std::int64_t count = 0;
  std::string detail;  ///< e.g. the name of the policy
};

/// Called from a middleware thread: enqueue or count, do not block.
using BusEventHandler = std::function<void(const BusEvent&)>;

}  // namespace limbcast::bus
