#include "common/bus/cyclone/cyclone_participant.hpp"

#include <gtest/gtest.h>

#include "common/bus/cyclone/cyclone_sertype.hpp"
#include "tests/unit/common/bus/test_domain.hpp"

namespace limbcast::bus::cyclone {
namespace {

using testing::CollectedEvents;
using testing::LoopbackConfig;

TEST(CycloneParticipantTest, ATopicIsMadeOnce) {
  const auto participant = CycloneParticipant::Make(LoopbackConfig(Vendor::kCyclone), {});
  ASSERT_TRUE(participant) << participant.error().message;
  const auto topic =
      (*participant)->TopicOf("limbcast/v1/marg", "marg", WireOpsOf<sensing::MargSample>());
  const auto again =
      (*participant)->TopicOf("limbcast/v1/marg", "marg", WireOpsOf<sensing::MargSample>());
  ASSERT_TRUE(topic && again);
  EXPECT_GT(topic->entity, 0);
  EXPECT_EQ(topic->entity, again->entity);
}

TEST(CycloneParticipantTest, APeerWithAnotherTypeUnderOurTopicIsNamed) {
  // Both ways round: the peer's endpoint known before our topic, and after.
  for (const bool ours_first : {true, false}) {
    CollectedEvents events;
    const auto ours = CycloneParticipant::Make(LoopbackConfig(Vendor::kCyclone), events.handler());
    const auto theirs = CycloneParticipant::Make(LoopbackConfig(Vendor::kCyclone), {});
    ASSERT_TRUE(ours && theirs);
    const auto make_ours = [&] {
      ASSERT_TRUE((*ours)->TopicOf("limbcast/v1/marg", "marg", WireOpsOf<sensing::MargSample>()));
    };
    if (ours_first) {
      make_ours();
    }
    const auto topic =
        (*theirs)->TopicOf("limbcast/v1/marg", "marg", WireOpsOf<sensing::FusedOrientation>());
    ASSERT_TRUE(topic);
    ASSERT_GT(dds_create_writer((*theirs)->publisher(), topic->entity, nullptr, nullptr), 0);
    if (!ours_first) {
      make_ours();
    }
    ASSERT_TRUE(events.WaitForEvent(BusEventKind::kTypeMismatch, false)) << ours_first;
    EXPECT_EQ(events.items().back().topic, "marg");
    EXPECT_EQ(events.items().back().detail,
              "ours is limbcast::wire::MargSample, a peer's limbcast::wire::FusedOrientation");
  }
}

TEST(CycloneParticipantTest, DescribesWhatItJoined) {
  BusConfig config = LoopbackConfig(Vendor::kCyclone);
  config.partition = "hall";
  config.peers = {"127.0.0.1:7410"};
  const auto participant = CycloneParticipant::Make(config, {});
  ASSERT_TRUE(participant) << participant.error().message;
  EXPECT_EQ((*participant)->Describe(),
            "Cyclone DDS 0.10.2, domain " + std::to_string(config.domain_id) +
                ", partition \"hall\", loopback only, peers 127.0.0.1:7410");
}

TEST(CycloneParticipantTest, ErrorsNameTheTopicAndTheReason) {
  const Error timeout = CycloneError("write", "limbcast/v1/marg", DDS_RETCODE_TIMEOUT);
  EXPECT_EQ(timeout.code, ErrorCode::kTimeout);
  EXPECT_EQ(timeout.message, "write limbcast/v1/marg: Timeout");
  EXPECT_EQ(CycloneError("x", "y", DDS_RETCODE_OUT_OF_RESOURCES).code, ErrorCode::kUnavailable);
}

}  // namespace
}  // namespace limbcast::bus::cyclone
