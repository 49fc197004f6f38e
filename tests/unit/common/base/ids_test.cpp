#include "common/base/ids.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace limbcast {
namespace {

TEST(MakeSensorUidTest, IsFnv1aOverDriverColonSerial) {
  // Published FNV-1a 64-bit test vectors: "" and "a" (here reached through the ":" between the
  // parts).
  const std::uint64_t basis = 14695981039346656037ULL;
  const std::uint64_t prime = 1099511628211ULL;
  EXPECT_EQ(MakeSensorUid("", "").value, (basis ^ static_cast<std::uint64_t>(':')) * prime);
}

TEST(MakeSensorUidTest, IsTheSameForTheSameSensorAlways) {
  // A changed value would give every known sensor a new identity: this is a wire promise.
  EXPECT_EQ(MakeSensorUid("simulator", "pelvis").value, MakeSensorUid("simulator", "pelvis").value);
  EXPECT_NE(MakeSensorUid("simulator", "pelvis"), MakeSensorUid("replay", "pelvis"));
}

TEST(MakeSensorUidTest, TellsThousandsOfSerialNumbersApart) {
  std::set<SensorUid> seen;
  for (int i = 0; i < 20000; ++i) {
    seen.insert(MakeSensorUid("acme", "00B4" + std::to_string(i)));
  }
  EXPECT_EQ(seen.size(), 20000U);
}

}  // namespace
}  // namespace limbcast
