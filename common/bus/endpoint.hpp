#pragma once

#include <cstdint>

namespace limbcast::bus {

/// What happened to one reader or writer so far; a snapshot.
struct EndpointCounters {
  std::uint64_t samples = 0;       ///< written, or delivered to the handler
  std::int32_t matched = 0;        ///< peers now
  std::int32_t alive_writers = 0;  ///< reader: remote writers alive now
  std::uint64_t incompatible_qos = 0;
  std::uint64_t lost = 0;  ///< reader: as told by the middleware
  std::uint64_t rejected = 0;
  std::uint64_t malformed = 0;
  std::uint64_t liveliness_lost = 0;  ///< reader: times that a remote writer went silent or died
  std::uint64_t disposed = 0;         ///< reader: instances disposed
};

}  // namespace limbcast::bus
