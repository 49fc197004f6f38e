#include "tools/limbcast/demo/demo_options.hpp"

#include <gtest/gtest.h>

namespace limbcast::tool {
namespace {

TEST(DemoOptionsTest, OneVendorIsTheSameForAll) {
  for (const char* process : {"gateway", "fusion", "posture", "client"}) {
    EXPECT_EQ(VendorOf(DemoDds::kCyclone, process), "cyclone");
    EXPECT_EQ(VendorOf(DemoDds::kFast, process), "fast");
  }
}

TEST(DemoOptionsTest, EveryHopOfAMixedDemoCrossesVendors) {
  EXPECT_NE(VendorOf(DemoDds::kMixed, "gateway"), VendorOf(DemoDds::kMixed, "fusion"));
  EXPECT_NE(VendorOf(DemoDds::kMixed, "fusion"), VendorOf(DemoDds::kMixed, "posture"));
  EXPECT_NE(VendorOf(DemoDds::kMixed, "posture"), VendorOf(DemoDds::kMixed, "client"));
}

}  // namespace
}  // namespace limbcast::tool
