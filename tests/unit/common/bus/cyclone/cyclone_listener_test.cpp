#include "common/bus/cyclone/cyclone_listener.hpp"

#include <gtest/gtest.h>

#include "common/bus/bus_factory.hpp"
#include "tests/unit/common/bus/test_domain.hpp"

namespace limbcast::bus::testing {
namespace {

// The listeners on real endpoints: each status becomes its event.
TEST(CycloneListenerTest, MatchingAndLivelinessBecomeEvents) {
  CollectedEvents events;
  const auto bus = Open(LoopbackConfig(Vendor::kCyclone), events.handler());
  ASSERT_TRUE(bus) << bus.error().message;
  const auto reader = (*bus)->MakeReader<sensing::MargSample>({});
  {
    const auto writer = (*bus)->MakeWriter<sensing::MargSample>();
    EXPECT_TRUE(events.WaitForEvent(BusEventKind::kMatched, true));
    EXPECT_TRUE(events.WaitForEvent(BusEventKind::kMatched, false));
    EXPECT_TRUE(events.WaitForEvent(BusEventKind::kLivelinessGained, false));
    EXPECT_EQ((*reader)->counters().alive_writers, 1);
  }
  EXPECT_TRUE(events.WaitForEvent(BusEventKind::kUnmatched, false));
  EXPECT_EQ((*reader)->counters().matched, 0);
  EXPECT_EQ((*reader)->counters().alive_writers, 0);
  EXPECT_EQ((*reader)->counters().liveliness_lost, 0U);  // it left in good order
}

TEST(CycloneListenerTest, AWriterSilentForItsLeaseIsLostUntilItWritesAgain) {
  CollectedEvents events;
  BusConfig config = LoopbackConfig(Vendor::kCyclone);
  config.stream_lease = std::chrono::milliseconds(100);
  const auto listening = Open(config, events.handler());
  const auto speaking = Open(config);
  ASSERT_TRUE(listening && speaking);
  const auto reader = (*listening)->MakeReader<sensing::MargSample>({});
  const auto writer = (*speaking)->MakeWriter<sensing::MargSample>();
  ASSERT_TRUE(events.WaitForEvent(BusEventKind::kLivelinessGained, false));
  ASSERT_TRUE(events.WaitForEvent(BusEventKind::kLivelinessLost, false));  // never wrote
  EXPECT_GE((*reader)->counters().liveliness_lost, 1U);
  ASSERT_TRUE((*writer)->Write({}));
  EXPECT_TRUE(events.WaitFor([](const auto& seen) {
    return std::count_if(seen.begin(), seen.end(), [](const BusEvent& event) {
             return event.kind == BusEventKind::kLivelinessGained;
           }) >= 2;
  }));
}

TEST(CycloneListenerTest, IncompatibleQosIsToldOnBothSidesWithThePolicy) {
  CollectedEvents reading;
  CollectedEvents writing;
  BusConfig config = LoopbackConfig(Vendor::kCyclone);
  const auto listening = Open(config, reading.handler());
  config.stream_lease = std::chrono::seconds(5);  // longer than the reader asks for
  const auto speaking = Open(config, writing.handler());
  ASSERT_TRUE(listening && speaking);
  const auto reader = (*listening)->MakeReader<sensing::MargSample>({});
  const auto writer = (*speaking)->MakeWriter<sensing::MargSample>();
  ASSERT_TRUE(reading.WaitForEvent(BusEventKind::kIncompatibleQos, false));
  ASSERT_TRUE(writing.WaitForEvent(BusEventKind::kIncompatibleQos, true));
  EXPECT_EQ(reading.items().front().detail, "liveliness");
  EXPECT_EQ(writing.items().front().detail, "liveliness");
  EXPECT_EQ((*reader)->counters().incompatible_qos, 1U);
  EXPECT_EQ((*writer)->counters().incompatible_qos, 1U);
}

}  // namespace
}  // namespace limbcast::bus::testing
