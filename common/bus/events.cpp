#include "common/bus/events.hpp"

#include <array>

namespace limbcast::bus {

std::string_view ToString(BusEventKind kind) {
  constexpr std::array<std::string_view, kBusEventKindCount> kNames = {
      "matched",   "unmatched",       "incompatible_qos",  "sample_lost",  "sample_rejected",
      "malformed", "liveliness_lost", "liveliness_gained", "type_mismatch"};
  const auto index = static_cast<std::size_t>(kind);
  return index < kNames.size() ? kNames[index] : "unknown";
}

}  // namespace limbcast::bus
