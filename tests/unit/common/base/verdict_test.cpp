#include "common/base/verdict.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string_view>

namespace limbcast {
namespace {

TEST(SampleVerdictTest, EveryVerdictHasItsOwnName) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < kSampleVerdictCount; ++i) {
    names.insert(ToString(static_cast<SampleVerdict>(i)));
  }
  EXPECT_EQ(names.size(), kSampleVerdictCount);
  EXPECT_EQ(ToString(static_cast<SampleVerdict>(kSampleVerdictCount)), "unknown");
}

TEST(VerdictCountersTest, UsedAndRefusedAddUpToAllSamples) {
  VerdictCounters counters;
  for (std::size_t i = 0; i < kSampleVerdictCount; ++i) {
    for (std::size_t n = 0; n <= i; ++n) {
      counters.Add(static_cast<SampleVerdict>(i));
    }
  }
  EXPECT_EQ(counters.used() + counters.refused(),
            kSampleVerdictCount * (kSampleVerdictCount + 1) / 2);
  EXPECT_EQ(counters.used(), 1U + 2U + 3U);
  EXPECT_EQ(counters[SampleVerdict::kRejectedDuplicate], 6U);
}

TEST(VerdictCountersTest, IsUsedAgreesWithTheSum) {
  for (std::size_t i = 0; i < kSampleVerdictCount; ++i) {
    VerdictCounters counters;
    counters.Add(static_cast<SampleVerdict>(i));
    EXPECT_EQ(counters.used() == 1U, IsUsed(static_cast<SampleVerdict>(i)));
  }
}

}  // namespace
}  // namespace limbcast
