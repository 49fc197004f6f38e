#include "common/base/ids.hpp"

namespace limbcast {

SensorUid MakeSensorUid(std::string_view driver, std::string_view serial) {
  constexpr std::uint64_t kOffsetBasis = 14695981039346656037ULL;
  constexpr std::uint64_t kPrime = 1099511628211ULL;
  std::uint64_t hash = kOffsetBasis;
  const auto mix = [&hash](std::string_view text) {
    for (const char c : text) {
      hash = (hash ^ static_cast<unsigned char>(c)) * kPrime;
    }
  };
  mix(driver);
  mix(":");
  mix(serial);
  return SensorUid{hash == 0 ? 1 : hash};
}

}  // namespace limbcast
