#include "common/base/ids.hpp"

#include "common/base/fnv1a.hpp"

namespace limbcast {

SensorUid MakeSensorUid(std::string_view driver, std::string_view serial) {
  const std::uint64_t hash = Fnv1a(Fnv1a(Fnv1a(kFnv1aBasis, driver), ":"), serial);
  return SensorUid{hash == 0 ? 1 : hash};
}

}  // namespace limbcast
