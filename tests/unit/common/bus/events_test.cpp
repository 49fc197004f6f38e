#include "common/bus/events.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace limbcast::bus {
namespace {

TEST(BusEventsTest, EveryKindHasANameOfItsOwn) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < kBusEventKindCount; ++i) {
    names.insert(ToString(static_cast<BusEventKind>(i)));
  }
  EXPECT_EQ(names.size(), kBusEventKindCount);
  EXPECT_FALSE(names.contains("unknown"));
  EXPECT_EQ(ToString(BusEventKind::kIncompatibleQos), "incompatible_qos");
  EXPECT_EQ(ToString(BusEventKind::kTypeMismatch), "type_mismatch");
}

TEST(BusEventsTest, ANumberBeyondTheLastKindIsUnknown) {
  EXPECT_EQ(ToString(static_cast<BusEventKind>(kBusEventKindCount)), "unknown");
}

}  // namespace
}  // namespace limbcast::bus
