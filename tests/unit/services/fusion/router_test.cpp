#include "services/fusion/router.hpp"

#include <gtest/gtest.h>

namespace limbcast::fusion {
namespace {

using body::Segment;

roster::RosterEntry Entry(std::uint32_t body_id, std::vector<roster::SensorAssignment> sensors) {
  roster::RosterEntry entry;
  entry.body_id = BodyId{body_id};
  entry.sensors = std::move(sensors);
  return entry;
}

TEST(RouterTest, ASensorLeadsToTheWorkerOfItsBody) {
  Router router({}, 3);
  EXPECT_EQ(router.Find(SensorUid{10}), nullptr);
  const auto plans =
      router.Apply(Entry(7, {{SensorUid{10}, Segment::kHead}, {SensorUid{11}, Segment::kPelvis}}));
  ASSERT_EQ(plans.size(), 1U);
  EXPECT_EQ(plans[0].tracks.size(), 2U);
  ASSERT_NE(router.Find(SensorUid{10}), nullptr);
  EXPECT_EQ(router.Find(SensorUid{10})->worker, 7U % 3U);
  EXPECT_EQ(router.Find(SensorUid{11})->worker, 7U % 3U);
  EXPECT_EQ(router.body_count(), 1U);
  EXPECT_EQ(router.sensor_count(), 2U);
}

TEST(RouterTest, TheSameEntryAgainChangesNothing) {
  Router router({}, 1);
  const auto entry = Entry(1, {{SensorUid{10}, Segment::kHead}});
  EXPECT_EQ(router.Apply(entry).size(), 1U);
  EXPECT_TRUE(router.Apply(entry).empty());
}

TEST(RouterTest, ASensorThatMovesToAnotherBodyLeavesTheFirst) {
  Router router({}, 2);
  (void)router.Apply(
      Entry(1, {{SensorUid{10}, Segment::kHead}, {SensorUid{11}, Segment::kPelvis}}));
  const auto plans = router.Apply(Entry(2, {{SensorUid{10}, Segment::kLeftFoot}}));
  ASSERT_EQ(plans.size(), 2U);
  EXPECT_EQ(plans[0].body_id, BodyId{1});
  ASSERT_EQ(plans[0].tracks.size(), 1U);
  EXPECT_EQ(plans[0].tracks[0].sensor_uid, SensorUid{11});
  EXPECT_EQ(plans[1].body_id, BodyId{2});
  EXPECT_EQ(plans[1].tracks[0].segment, Segment::kLeftFoot);
  EXPECT_EQ(router.Find(SensorUid{10})->body_id, BodyId{2});
}

TEST(RouterTest, ASensorThatIsNoLongerNamedAndABodyThatLeavesHaveNoRoute) {
  Router router({}, 1);
  (void)router.Apply(
      Entry(1, {{SensorUid{10}, Segment::kHead}, {SensorUid{11}, Segment::kPelvis}}));
  (void)router.Apply(Entry(1, {{SensorUid{11}, Segment::kPelvis}}));
  EXPECT_EQ(router.Find(SensorUid{10}), nullptr);
  const auto plans = router.Remove(BodyId{1});
  ASSERT_EQ(plans.size(), 1U);
  EXPECT_TRUE(plans[0].tracks.empty());
  EXPECT_EQ(router.Find(SensorUid{11}), nullptr);
  EXPECT_TRUE(router.Remove(BodyId{1}).empty());
}

TEST(RouterTest, ASensorThatStaysKeepsItsOverloads) {
  Router router({}, 1);
  (void)router.Apply(Entry(1, {{SensorUid{10}, Segment::kHead}}));
  router.Find(SensorUid{10})->overloads = 5;
  const auto plans = router.Apply(Entry(1, {{SensorUid{10}, Segment::kNeck}}));
  EXPECT_EQ(plans[0].tracks[0].overloads, 5U);
}

TEST(RouterTest, AssignmentsThatCannotBeAreLeftOutAndCounted) {
  Router router({}, 1);
  const auto plans = router.Apply(Entry(1, {{SensorUid{10}, Segment::kHead},
                                            {SensorUid{11}, Segment::kHead},
                                            {SensorUid{10}, Segment::kNeck},
                                            {SensorUid{0}, Segment::kPelvis},
                                            {SensorUid{12}, static_cast<Segment>(99)}}));
  ASSERT_EQ(plans.size(), 1U);
  ASSERT_EQ(plans[0].tracks.size(), 1U);
  EXPECT_EQ(plans[0].tracks[0].sensor_uid, SensorUid{10});
  EXPECT_EQ(router.refused_assignments(), 4U);
}

TEST(RouterTest, FiltersComeFromTheDefaultTheSegmentAndTheCommandInThisOrder) {
  FusionConfig config;
  config.filter = {.name = "a", .beside = ""};
  config.segment_filters[Segment::kHead] = {.name = "b", .beside = "c"};
  Router router(config, 1);
  auto plans =
      router.Apply(Entry(1, {{SensorUid{10}, Segment::kPelvis}, {SensorUid{11}, Segment::kHead}}));
  EXPECT_EQ(plans[0].tracks[0].filters, (FilterChoice{"a", ""}));
  EXPECT_EQ(plans[0].tracks[1].filters, (FilterChoice{"b", "c"}));

  const std::array head = {Segment::kHead};
  auto selected = router.Select(BodyId{1}, head, 0, "d");
  ASSERT_TRUE(selected.ok());
  EXPECT_EQ((*selected)[0].tracks[0].filters, (FilterChoice{"a", ""}));
  EXPECT_EQ((*selected)[0].tracks[1].filters, (FilterChoice{"d", "c"}));

  selected = router.Select(BodyId{0}, {}, 1, "e");
  ASSERT_TRUE(selected.ok());
  EXPECT_EQ((*selected)[0].tracks[0].filters, (FilterChoice{"a", "e"}));
  EXPECT_EQ((*selected)[0].tracks[1].filters, (FilterChoice{"d", "e"}));
  plans = router.Apply(Entry(2, {{SensorUid{20}, Segment::kPelvis}}));
  EXPECT_EQ(plans[0].tracks[0].filters, (FilterChoice{"a", "e"})) << "bodies that come later too";
}

TEST(RouterTest, AFilterForABodyThatIsNotThereIsRefused) {
  Router router({}, 1);
  const auto selected = router.Select(BodyId{9}, {}, 0, "a");
  ASSERT_FALSE(selected.ok());
  EXPECT_EQ(selected.error().code, ErrorCode::kNotFound);
  EXPECT_EQ(selected.error().message, "body 9 is not in the roster");
}

}  // namespace
}  // namespace limbcast::fusion
