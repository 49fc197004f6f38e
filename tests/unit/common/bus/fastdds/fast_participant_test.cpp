#include "common/bus/fastdds/fast_participant.hpp"

#include <gtest/gtest.h>

#include <fastdds/dds/publisher/DataWriter.hpp>

#include "common/bus/fastdds/fast_type.hpp"
#include "tests/unit/common/bus/test_domain.hpp"

namespace limbcast::bus::fastdds {
namespace {

using eprosima::fastdds::dds::TypeSupport;
using testing::CollectedEvents;
using testing::LoopbackConfig;

TypeSupport MargType() { return TypeSupport(new FastType<sensing::MargSample>()); }
TypeSupport OtherType() { return TypeSupport(new FastType<sensing::FusedOrientation>()); }

TEST(FastParticipantTest, ATopicIsMadeOnce) {
  const auto participant = FastParticipant::Make(LoopbackConfig(Vendor::kFast), {});
  ASSERT_TRUE(participant) << participant.error().message;
  const auto topic = (*participant)->TopicOf("limbcast/v1/marg", "marg", MargType());
  const auto again = (*participant)->TopicOf("limbcast/v1/marg", "marg", MargType());
  ASSERT_TRUE(topic && again);
  EXPECT_EQ(*topic, *again);
}

TEST(FastParticipantTest, APeerWithAnotherTypeUnderOurTopicIsNamed) {
  // Both ways round: the peer's endpoint known before our topic, and after.
  for (const bool ours_first : {true, false}) {
    CollectedEvents events;
    CollectedEvents met;
    const auto ours = FastParticipant::Make(LoopbackConfig(Vendor::kFast), events.handler());
    const auto theirs = FastParticipant::Make(LoopbackConfig(Vendor::kFast), {});
    ASSERT_TRUE(ours && theirs);
    if (ours_first) {
      ASSERT_TRUE((*ours)->TopicOf("limbcast/v1/marg", "marg", MargType()));
    }
    const auto topic = (*theirs)->TopicOf("limbcast/v1/marg", "marg", OtherType());
    ASSERT_TRUE(topic);
    ASSERT_NE(
        (*theirs)->publisher().create_datawriter(*topic, eprosima::fastdds::dds::DataWriterQos()),
        nullptr);
    if (!ours_first) {
      ASSERT_TRUE((*ours)->TopicOf("limbcast/v1/marg", "marg", MargType()));
    }
    ASSERT_TRUE(events.WaitForEvent(BusEventKind::kTypeMismatch, false)) << ours_first;
    EXPECT_EQ(events.items().back().topic, "marg");
    EXPECT_EQ(events.items().back().detail,
              "ours is limbcast::wire::MargSample, a peer's limbcast::wire::FusedOrientation");
  }
}

TEST(FastParticipantTest, DescribesWhatItJoined) {
  BusConfig config = LoopbackConfig(Vendor::kFast);
  config.partition = "hall";
  config.peers = {"127.0.0.1"};
  const auto participant = FastParticipant::Make(config, {});
  ASSERT_TRUE(participant) << participant.error().message;
  EXPECT_EQ((*participant)->Describe(), "Fast DDS 2.9.1, domain " +
                                            std::to_string(config.domain_id) +
                                            ", partition \"hall\", loopback only, peers 127.0.0.1");
}

TEST(FastParticipantTest, TheHundredthOfAProcessIsStillFound) {
  // Peers call the first 64 numbers only; the library alone would be far beyond by then.
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(FastParticipant::Make(LoopbackConfig(Vendor::kFast), {})) << i;
  }
  CollectedEvents events;
  const auto a = FastParticipant::Make(LoopbackConfig(Vendor::kFast), events.handler());
  const auto b = FastParticipant::Make(LoopbackConfig(Vendor::kFast), {});
  ASSERT_TRUE(a && b);
  ASSERT_TRUE((*a)->TopicOf("limbcast/v1/marg", "marg", MargType()));
  const auto topic = (*b)->TopicOf("limbcast/v1/marg", "marg", OtherType());
  ASSERT_NE((*b)->publisher().create_datawriter(*topic, eprosima::fastdds::dds::DataWriterQos()),
            nullptr);
  EXPECT_TRUE(events.WaitForEvent(BusEventKind::kTypeMismatch, false)) << "they do not meet";
}

}  // namespace
}  // namespace limbcast::bus::fastdds
