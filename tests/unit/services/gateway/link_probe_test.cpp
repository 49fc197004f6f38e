#include "services/gateway/link_probe.hpp"

#include <gtest/gtest.h>

namespace limbcast::gateway {
namespace {

constexpr Time kStart = TimeFromNanoseconds(1000);
constexpr Time kLater = TimeFromNanoseconds(2000);

TEST(LinkProbeTest, EverySensorMustAnswer) {
  LinkProbe probe(WaitFor::kFusion, {SensorUid{1}, SensorUid{2}}, {BodyId{1}});
  probe.Start(kStart);
  probe.OnState(SensorUid{1}, kLater);
  EXPECT_FALSE(probe.open());
  EXPECT_EQ(probe.Missing(), "fusion: 1 of 2 sensors silent");
  probe.OnState(SensorUid{2}, kLater);
  EXPECT_TRUE(probe.open());
  EXPECT_EQ(probe.Missing(), "");
}

TEST(LinkProbeTest, AnswersToEarlierStreamsDoNotCount) {
  LinkProbe probe(WaitFor::kFusion, {SensorUid{1}}, {});
  probe.Start(kStart);
  probe.OnState(SensorUid{1}, TimeFromNanoseconds(999));
  EXPECT_FALSE(probe.open());
}

TEST(LinkProbeTest, PostureMustAnswerForEveryBody) {
  LinkProbe probe(WaitFor::kPosture, {SensorUid{1}}, {BodyId{1}, BodyId{2}});
  probe.Start(kStart);
  probe.OnState(SensorUid{1}, kLater);
  probe.OnSkeleton(BodyId{1}, kLater);
  EXPECT_FALSE(probe.open());
  EXPECT_EQ(probe.Missing(), "posture: 1 of 2 bodies silent");
  probe.OnSkeleton(BodyId{2}, kLater);
  EXPECT_TRUE(probe.open());
}

TEST(LinkProbeTest, WithoutKnownSensorsOneAnswerWillDo) {
  LinkProbe probe(WaitFor::kFusion, {}, {});
  probe.Start(kStart);
  EXPECT_FALSE(probe.open());
  probe.OnState(SensorUid{9}, kLater);
  EXPECT_TRUE(probe.open());
}

TEST(LinkProbeTest, NothingToWaitForIsOpen) {
  EXPECT_TRUE(LinkProbe(WaitFor::kNone, {}, {}).open());
}

}  // namespace
}  // namespace limbcast::gateway
