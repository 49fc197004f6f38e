#include "common/bus/endpoint_events.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace limbcast::bus {
namespace {

class EndpointEventsTest : public ::testing::Test {
 protected:
  std::vector<BusEvent> seen_;
  std::shared_ptr<EventSink> sink_ =
      std::make_shared<EventSink>([this](const BusEvent& event) { seen_.push_back(event); });
  EndpointEvents events_{"marg", false, sink_};
};

TEST_F(EndpointEventsTest, CountsAndTellsWhatHappened) {
  events_.Matched(2, 2);
  events_.Matched(-1, 1);
  events_.IncompatibleQos(1, "liveliness");
  events_.Lost(3);
  events_.Rejected(2, "no room");
  events_.Malformed("bytes");
  events_.Sample();
  events_.Disposed();

  const EndpointCounters counters = events_.counters();
  EXPECT_EQ(counters.matched, 1);
  EXPECT_EQ(counters.incompatible_qos, 1U);
  EXPECT_EQ(counters.lost, 3U);
  EXPECT_EQ(counters.rejected, 2U);
  EXPECT_EQ(counters.malformed, 1U);
  EXPECT_EQ(counters.samples, 1U);
  EXPECT_EQ(counters.disposed, 1U);

  ASSERT_EQ(seen_.size(), 6U);  // samples and disposals are no events
  EXPECT_EQ(seen_[0].kind, BusEventKind::kMatched);
  EXPECT_EQ(seen_[0].count, 2);
  EXPECT_EQ(seen_[0].topic, "marg");
  EXPECT_FALSE(seen_[0].from_writer);
  EXPECT_EQ(seen_[1].kind, BusEventKind::kUnmatched);
  EXPECT_EQ(seen_[1].count, 1);
  EXPECT_EQ(seen_[2].detail, "liveliness");
  EXPECT_EQ(seen_[3].count, 3);
}

TEST_F(EndpointEventsTest, ASilentWriterIsLostALeavingOneIsNot) {
  events_.Liveliness(2, 0);
  events_.Liveliness(1, 0);
  EXPECT_EQ(events_.counters().liveliness_lost, 0U);
  events_.Liveliness(0, 1);
  EXPECT_EQ(events_.counters().liveliness_lost, 1U);
  EXPECT_EQ(events_.counters().alive_writers, 0);
  ASSERT_EQ(seen_.size(), 2U);
  EXPECT_EQ(seen_[0].kind, BusEventKind::kLivelinessGained);
  EXPECT_EQ(seen_[1].kind, BusEventKind::kLivelinessLost);
}

TEST_F(EndpointEventsTest, ASilentWriterThatReturnsIsGainedAgain) {
  events_.Liveliness(1, 0);
  events_.Liveliness(0, 1);
  events_.Liveliness(1, 0);
  events_.Liveliness(1, 0);  // told twice: once is enough
  events_.Liveliness(0, 1);
  EXPECT_EQ(events_.counters().liveliness_lost, 2U);
  ASSERT_EQ(seen_.size(), 4U);
  EXPECT_EQ(seen_[1].kind, BusEventKind::kLivelinessLost);
  EXPECT_EQ(seen_[2].kind, BusEventKind::kLivelinessGained);
  EXPECT_EQ(seen_[2].count, 1);
  EXPECT_EQ(seen_[3].kind, BusEventKind::kLivelinessLost);
}

TEST_F(EndpointEventsTest, AfterCloseNothingIsToldButStillCounted) {
  sink_->Close();
  events_.Lost(1);
  EXPECT_TRUE(seen_.empty());
  EXPECT_EQ(events_.counters().lost, 1U);
}

}  // namespace
}  // namespace limbcast::bus
