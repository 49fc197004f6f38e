#include "services/gateway/tick_source.hpp"

#include <gtest/gtest.h>

#include "tests/unit/services/gateway/fake_driver.hpp"

namespace limbcast::gateway {
namespace {

using namespace std::chrono_literals;

constexpr Time kNow = TimeFromNanoseconds(1'700'000'000'000'000'000);

GatewayConfig Looping() {
  GatewayConfig config;
  config.loop = true;
  return config;
}

TEST(TickSourceTest, TimesAndBodiesAreThoseOfTheNetwork) {
  auto driver = std::make_unique<test::FakeDriver>(1, 2);
  driver->with_truth = true;
  GatewayConfig config;
  config.session = "s";
  config.body_id = 9;
  TickSource source(std::move(driver), config);
  EXPECT_EQ(source.description().bodies[0].body_id, BodyId{9});
  EXPECT_EQ(source.description().bodies[0].session, "s");
  ASSERT_EQ(*source.Load(kNow), DriverStep::kData);
  EXPECT_EQ(source.DueAt(kNow), kNow);
  const Batch& batch = source.Take(kNow);
  EXPECT_EQ(batch.marg[0].measured_at, kNow);
  EXPECT_EQ(batch.truth[0].measured_at, kNow);
  EXPECT_EQ(batch.truth[0].body_id, BodyId{9});
}

TEST(TickSourceTest, TimesOfMarkersAndCoilPulsesMoveWithTheTick) {
  auto driver = std::make_unique<test::FakeDriver>(1, 1);
  driver->extra = [](Batch& batch) {
    batch.markers.push_back({.body_id = BodyId{1}, .measured_at = batch.tick_at - 4ms});
    sensing::CoilBurst burst;
    burst.measured_at = batch.tick_at - 20ms;
    burst.pulses[1].on_at = batch.tick_at - 30ms;
    burst.pulses[1].off_at = batch.tick_at - 10ms;
    batch.coil_bursts.push_back(burst);
  };
  GatewayConfig config;
  config.body_id = 9;
  TickSource source(std::move(driver), config);
  ASSERT_EQ(*source.Load(kNow), DriverStep::kData);
  const Batch& batch = source.Take(kNow);
  EXPECT_EQ(batch.markers[0].measured_at, kNow - 4ms);
  EXPECT_EQ(batch.markers[0].body_id, BodyId{9});
  EXPECT_EQ(batch.coil_bursts[0].measured_at, kNow - 20ms);
  EXPECT_EQ(batch.coil_bursts[0].pulses[1].on_at, kNow - 30ms);
  EXPECT_EQ(batch.coil_bursts[0].pulses[1].off_at, kNow - 10ms);
  EXPECT_EQ(batch.coil_bursts[0].pulses[0].off_at, Time{});  // that coil has not pulsed yet
}

TEST(TickSourceTest, TheDriverIsToldOfSlotsInItsOwnTimeAndBodiesOnceForEachChange) {
  auto driver = std::make_unique<test::FakeDriver>(1, 5);
  test::FakeDriver& fake = *driver;
  GatewayConfig config;
  config.body_id = 9;
  TickSource source(std::move(driver), config);
  const auto schedule = std::make_shared<CoilSchedule>();
  schedule->own = {{.body_id = BodyId{9}, .grant = sensing::CoilGrant{.slot = 1, .slots = 2}}};
  schedule->foreign = {sensing::CoilGrant{.slot = 0, .slots = 2}};
  EXPECT_TRUE(source.FollowSlots(schedule, kNow).ok());
  ASSERT_EQ(*source.Load(kNow), DriverStep::kData);
  ASSERT_EQ(fake.schedules.size(), 1U);
  EXPECT_EQ(fake.schedules[0].own[0].body_id, BodyId{1});
  EXPECT_EQ(fake.schedules[0].own[0].grant, schedule->own[0].grant);
  EXPECT_EQ(fake.schedules[0].foreign, schedule->foreign);
  EXPECT_EQ(fake.schedules[0].to_host, kNow.time_since_epoch());
  (void)source.Take(kNow);
  EXPECT_TRUE(source.FollowSlots(schedule, kNow + 10ms).ok());
  EXPECT_EQ(fake.schedules.size(), 1U) << "nothing changed";
  fake.fits = Error{ErrorCode::kInvalidArgument, "too long"};
  const auto other = std::make_shared<CoilSchedule>(*schedule);
  other->own[0].grant.reset();
  EXPECT_EQ(source.FollowSlots(other, kNow + 10ms).error().message, "too long");
  ASSERT_EQ(fake.schedules.size(), 2U);
  EXPECT_FALSE(fake.schedules[1].own[0].grant);
  EXPECT_TRUE(source.FollowSlots(other, kNow + 10ms).ok()) << "said once";
}

TEST(TickSourceTest, BodiesAreThoseThatTheSessionHostGave) {
  auto driver = std::make_unique<test::FakeDriver>(1, 2);
  driver->with_truth = true;
  GatewayConfig config;
  config.body_id = 9;
  config.granted_bodies = {BodyId{77}};
  config.person = "Ada";
  TickSource source(std::move(driver), config);
  EXPECT_EQ(source.description().bodies[0].body_id, BodyId{77});
  EXPECT_EQ(source.description().bodies[0].person, "Ada");
  ASSERT_EQ(*source.Load(kNow), DriverStep::kData);
  EXPECT_EQ(source.Take(kNow).truth[0].body_id, BodyId{77});
}

TEST(TickSourceTest, LoopsAreJoinedWithOnePeriodBetween) {
  TickSource source(std::make_unique<test::FakeDriver>(1, 3), Looping());
  for (int tick = 0; tick < 7; ++tick) {
    ASSERT_EQ(*source.Load(kNow), DriverStep::kData);
    const Time due = source.DueAt(kNow);
    EXPECT_EQ(source.Take(due).marg[0].measured_at, kNow + tick * 10ms);
  }
  EXPECT_EQ(source.loops(), 2U);
  EXPECT_EQ(source.streamed(), 60ms);
}

TEST(TickSourceTest, EmptyDriverDoesNotLoopForEver) {
  TickSource source(std::make_unique<test::FakeDriver>(1, 0), Looping());
  EXPECT_EQ(*source.Load(kNow), DriverStep::kEnd);
  EXPECT_FALSE(source.loaded());
}

TEST(TickSourceTest, LiveTimesAreLeftAlone) {
  auto driver = std::make_unique<test::FakeDriver>(1, 3);
  driver->description().time = DriverTime::kHost;
  TickSource source(std::move(driver), {});
  ASSERT_EQ(*source.Load(kNow), DriverStep::kData);
  EXPECT_EQ(source.DueAt(kNow), kNow);
  EXPECT_EQ(source.DueInRealTime(kNow), kNow);
  EXPECT_EQ(source.Take(kNow).marg[0].measured_at, Time{});
}

}  // namespace
}  // namespace limbcast::gateway
