#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <string_view>

namespace limbcast {

/// One tracked person within a session.
struct BodyId {
  std::uint32_t value = 0;
  auto operator<=>(const BodyId&) const = default;
};

/// One physical sensor (or coil source), wherever it is plugged in: a stable hash of driver and
/// serial number, never of an address. 0 means "none".
struct SensorUid {
  std::uint64_t value = 0;
  auto operator<=>(const SensorUid&) const = default;
};

/// FNV-1a, 64 bit, over "driver:serial" (never 0). The same sensor has the same uid on every host
/// and after every restart. http://www.isthe.com/chongo/tech/comp/fnv/
[[nodiscard]] SensorUid MakeSensorUid(std::string_view driver, std::string_view serial);

}  // namespace limbcast

template <>
struct std::hash<limbcast::BodyId> {
  std::size_t operator()(limbcast::BodyId id) const noexcept {
    return std::hash<std::uint32_t>{}(id.value);
  }
};
template <>
struct std::hash<limbcast::SensorUid> {
  std::size_t operator()(limbcast::SensorUid uid) const noexcept {
    return std::hash<std::uint64_t>{}(uid.value);
  }
};
