#include "common/bus/bus_factory.hpp"

#include <gtest/gtest.h>

#include "tests/unit/common/bus/test_domain.hpp"

namespace limbcast::bus::testing {
namespace {

TEST(BusFactoryTest, ABadValueIsRefusedBeforeAnythingIsOpened) {
  for (const Vendor vendor : {Vendor::kInproc, Vendor::kCyclone, Vendor::kFast}) {
    const auto opened = Open({.vendor = vendor, .domain_id = 200});
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().code, ErrorCode::kInvalidArgument);
    EXPECT_EQ(opened.error().message, "bus.domain_id must be in [0, 101], is 200");
  }
}

TEST(BusFactoryTest, EachVendorDescribesItself) {
  BusConfig config = LoopbackConfig(Vendor::kInproc);
  config.partition = "hall";
  const auto inproc = Open(config);
  ASSERT_TRUE(inproc) << inproc.error().message;
  EXPECT_EQ((*inproc)->Describe(), "inproc, domain " + std::to_string(config.domain_id) +
                                       ", partition \"hall\", this process only");
  config.vendor = Vendor::kCyclone;
  const auto cyclone = Open(config);
  ASSERT_TRUE(cyclone) << cyclone.error().message;
  EXPECT_NE((*cyclone)->Describe().find("Cyclone DDS 0.10"), std::string::npos);
  config.vendor = Vendor::kFast;
  const auto fast = Open(config);
  ASSERT_TRUE(fast) << fast.error().message;
  EXPECT_NE((*fast)->Describe().find("Fast DDS"), std::string::npos);
}

TEST(BusFactoryTest, InprocBusesOfOneDomainHearEachOtherAndOthersDoNot) {
  const auto a = Open({.vendor = Vendor::kInproc, .domain_id = 7});
  const auto b = Open({.vendor = Vendor::kInproc, .domain_id = 7});
  const auto other = Open({.vendor = Vendor::kInproc, .domain_id = 8});
  int heard = 0;
  int heard_elsewhere = 0;
  const auto reader =
      (*b)->MakeReader<roster::Command>({.on_sample = [&](const auto&, const auto&) { ++heard; }});
  const auto elsewhere = (*other)->MakeReader<roster::Command>(
      {.on_sample = [&](const auto&, const auto&) { ++heard_elsewhere; }});
  ASSERT_TRUE((*(*a)->MakeWriter<roster::Command>())->Write({}));
  EXPECT_EQ(heard, 1);
  EXPECT_EQ(heard_elsewhere, 0);
}

TEST(BusFactoryTest, AnInterfaceThatIsNotThereIsNamed) {
  for (const Vendor vendor : {Vendor::kCyclone, Vendor::kFast}) {
    BusConfig config = LoopbackConfig(vendor);
    config.network = NetworkProfile::kInterfaces;
    config.interfaces = {"nosuch0"};
    const auto opened = Open(config);
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().code, ErrorCode::kUnavailable);
    EXPECT_NE(opened.error().message.find("nosuch0"), std::string::npos) << opened.error().message;
  }
}

}  // namespace
}  // namespace limbcast::bus::testing
