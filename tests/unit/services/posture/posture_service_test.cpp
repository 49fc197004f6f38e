#include "services/posture/posture_service.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "common/math/rotation.hpp"
#include "tests/unit/common/filters/allocation_counter.hpp"
#include "tests/unit/services/posture/posture_rig.hpp"

namespace limbcast::posture {
namespace {

using body::Segment;
using body::SegmentStatus;
using ::testing::HasSubstr;
using namespace std::chrono_literals;

constexpr BodyId kBody{1};
const std::vector<Segment> kThree = {Segment::kPelvis, Segment::kT8, Segment::kHead};

TEST(PostureServiceTest, ACompleteTickIsEmittedAtOnceWithoutWaiting) {
  PostureRig rig;
  ASSERT_TRUE(rig.started.ok());
  rig.Roster(MakeRoster(kBody, kThree));
  rig.Tick(kBody, kThree);
  ASSERT_EQ(rig.skeletons.size(), 1U);
  const body::Skeleton& skeleton = rig.skeletons[0];
  EXPECT_TRUE(skeleton.complete);
  EXPECT_EQ(skeleton.body_id, kBody);
  EXPECT_EQ(skeleton.sequence, 1U);
  EXPECT_EQ(skeleton.measured_at, rig.clock.Now());
  ASSERT_EQ(skeleton.segments.size(), body::kSegmentCount);
  EXPECT_EQ(rig.Last(Segment::kT8).status, SegmentStatus::kTracked);
  EXPECT_EQ(rig.Last(Segment::kL5).status, SegmentStatus::kFilled);
  EXPECT_GT(rig.Last(Segment::kT8).confidence, rig.Last(Segment::kL5).confidence);
  EXPECT_EQ(rig.Counted(Count::kSkeletonsComplete), 1U);
}

TEST(PostureServiceTest, EveryTickGivesOneSkeletonAndNoneTwice) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, kThree));
  rig.Run(kBody, kThree, 1.0);
  rig.Advance(1s);
  ASSERT_EQ(rig.skeletons.size(), 100U);
  for (std::size_t i = 1; i < rig.skeletons.size(); ++i) {
    EXPECT_EQ(rig.skeletons[i].sequence, i + 1);
    EXPECT_EQ(rig.skeletons[i].measured_at - rig.skeletons[i - 1].measured_at, 10ms);
  }
  EXPECT_EQ(rig.Counted(Count::kStatesUsed), 300U);
  EXPECT_EQ(rig.Counted(Count::kSkeletonsDeadline), 0U);
}

TEST(PostureServiceTest, AMissingStateIsWaitedForUntilTheDeadlineAndThenSaidToBeStale) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, kThree));
  rig.Run(kBody, kThree, 0.1);
  const std::size_t before = rig.skeletons.size();
  rig.Advance(10ms);
  rig.Tick(kBody, {Segment::kPelvis, Segment::kT8});
  rig.Advance(7999us);
  EXPECT_EQ(rig.skeletons.size(), before) << "the deadline is 8 ms after the first arrival";
  rig.Advance(1us);
  ASSERT_EQ(rig.skeletons.size(), before + 1);
  EXPECT_FALSE(rig.skeletons.back().complete);
  EXPECT_EQ(rig.Last(Segment::kHead).status, SegmentStatus::kStale);
  EXPECT_EQ(rig.Last(Segment::kT8).status, SegmentStatus::kTracked);
  EXPECT_EQ(rig.Counted(Count::kSkeletonsDeadline), 1U);
}

TEST(PostureServiceTest, ALateStateIsCountedAndEmitsNothing) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, kThree));
  rig.Run(kBody, kThree, 0.1);
  rig.Advance(10ms);
  const Time tick = rig.clock.Now();
  rig.Tick(kBody, {Segment::kPelvis, Segment::kT8});
  rig.Advance(8ms);
  const std::size_t emitted = rig.skeletons.size();
  rig.Send(MakeState(kBody, Segment::kHead, tick));
  rig.Advance(1s);
  EXPECT_EQ(rig.skeletons.size(), emitted);
  EXPECT_EQ(rig.Counted(Count::kStatesLate), 1U);
}

TEST(PostureServiceTest, AVanishedSensorBecomesStaleThenMissingAndTheBodyGoesOnWithoutWaiting) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, kThree));
  rig.Run(kBody, kThree, 0.5);
  rig.Run(kBody, {Segment::kPelvis, Segment::kT8}, 0.5);
  EXPECT_EQ(rig.Last(Segment::kHead).status, SegmentStatus::kStale);
  const float early = rig.Last(Segment::kHead).confidence;
  rig.Run(kBody, {Segment::kPelvis, Segment::kT8}, 1.0);
  EXPECT_LT(rig.Last(Segment::kHead).confidence, early) << "falls with age";
  rig.Run(kBody, {Segment::kPelvis, Segment::kT8}, 1.0);
  EXPECT_EQ(rig.Last(Segment::kHead).status, SegmentStatus::kMissing);
  EXPECT_FLOAT_EQ(rig.Last(Segment::kHead).confidence, 0.0F);
  EXPECT_EQ(rig.Last(Segment::kT8).status, SegmentStatus::kTracked);
  const std::size_t before = rig.skeletons.size();
  rig.Advance(10ms);
  rig.Tick(kBody, {Segment::kPelvis, Segment::kT8});
  EXPECT_EQ(rig.skeletons.size(), before + 1) << "a missing sensor is not waited for";

  rig.Run(kBody, kThree, 0.1);
  EXPECT_EQ(rig.Last(Segment::kHead).status, SegmentStatus::kTracked) << "and comes back";
}

TEST(PostureServiceTest, ProbesOfSegmentsThatHaveNotStartedGiveASkeletonOfMissingSegments) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, kThree));
  for (const Segment segment : kThree) {
    body::SegmentState probe = MakeState(kBody, segment, rig.clock.Now());
    probe.started = false;
    probe.verdict = SampleVerdict::kNoData;
    rig.Send(probe);
  }
  ASSERT_EQ(rig.skeletons.size(), 1U);
  EXPECT_FALSE(rig.skeletons[0].complete);
  for (const Segment segment : kThree) {
    EXPECT_EQ(rig.Last(segment).status, SegmentStatus::kMissing);
    EXPECT_FLOAT_EQ(rig.Last(segment).confidence, 0.0F);
  }
  EXPECT_EQ(rig.Counted(Count::kProbes), 1U);
  EXPECT_EQ(rig.Counted(Count::kSkeletons), 0U);
}

TEST(PostureServiceTest, ASensorThatNeverSpeaksCostsTheDeadlineOnlyAtFirst) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, kThree));
  rig.Run(kBody, {Segment::kPelvis, Segment::kT8}, 1.0);
  EXPECT_EQ(rig.Counted(Count::kSkeletonsDeadline), rig.Counted(Count::kSkeletons));
  EXPECT_EQ(rig.Last(Segment::kHead).status, SegmentStatus::kMissing);
  rig.Run(kBody, {Segment::kPelvis, Segment::kT8}, 1.5);
  const std::uint64_t deadlines = rig.Counted(Count::kSkeletonsDeadline);
  const std::uint64_t skeletons = rig.Counted(Count::kSkeletons);
  rig.Run(kBody, {Segment::kPelvis, Segment::kT8}, 1.0);
  EXPECT_EQ(rig.Counted(Count::kSkeletonsDeadline), deadlines);
  EXPECT_EQ(rig.Counted(Count::kSkeletons), skeletons + 100);
}

TEST(PostureServiceTest, SensorsThatSampleAtDifferentInstantsMakeOneSkeletonAPeriod) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, kThree));
  for (int tick = 0; tick < 100; ++tick) {
    for (const Segment segment : kThree) {
      rig.Advance(segment == Segment::kPelvis ? 4ms : 3ms);
      rig.Send(MakeState(kBody, segment, rig.clock.Now()));
    }
  }
  EXPECT_EQ(rig.skeletons.size(), 100U);
  EXPECT_EQ(rig.Counted(Count::kSkeletonsComplete), 100U);
  EXPECT_EQ(rig.Counted(Count::kStatesLate), 0U);
}

TEST(PostureServiceTest, AnEarlierMeasurementIsTurnedOnToTheInstantOfTheSkeleton) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, {Segment::kPelvis, Segment::kT8}));
  body::SegmentState state = MakeState(kBody, Segment::kPelvis, rig.clock.Now());
  state.w_earth_sensor_in_sensor_rad_s = {0.0F, 0.0F, 5.0F};
  rig.Send(state);
  rig.Advance(4ms);
  rig.Send(MakeState(kBody, Segment::kT8, rig.clock.Now()));
  ASSERT_EQ(rig.skeletons.size(), 1U);
  EXPECT_NEAR(math::Heading_rad(rig.Last(Segment::kPelvis).q_earth_segment.cast<double>()),
              5.0 * 0.004, 1e-6);
}

TEST(PostureServiceTest, ALostSampleInAFastReplayEndsTheTickWhenTheNextOneOvertakes) {
  PostureRig rig;  // the clock stands still: no deadline can help
  rig.Roster(MakeRoster(kBody, kThree));
  const Time start = rig.clock.Now();
  for (int tick = 0; tick < 10; ++tick) {
    for (const Segment segment : kThree) {
      if (tick != 4 || segment != Segment::kT8) {
        rig.Send(MakeState(kBody, segment, start + tick * 10ms));
      }
    }
  }
  ASSERT_EQ(rig.skeletons.size(), 10U);
  EXPECT_EQ(rig.Counted(Count::kSkeletonsOvertaken), 1U);
  EXPECT_FALSE(rig.skeletons[4].complete);
  EXPECT_TRUE(rig.skeletons[5].complete);
}

TEST(PostureServiceTest, ARefusedSampleAnswersTheTickButIsNotAMeasurement) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, kThree));
  rig.Run(kBody, kThree, 0.05);
  rig.Advance(10ms);
  rig.Tick(kBody, {Segment::kPelvis, Segment::kT8});
  body::SegmentState refused = MakeState(kBody, Segment::kHead, rig.clock.Now());
  refused.verdict = SampleVerdict::kRejectedSaturated;
  const std::size_t before = rig.skeletons.size();
  rig.Send(refused);
  ASSERT_EQ(rig.skeletons.size(), before + 1) << "nobody waits for another";
  EXPECT_FALSE(rig.skeletons.back().complete);
  EXPECT_EQ(rig.Last(Segment::kHead).status, SegmentStatus::kStale);
}

TEST(PostureServiceTest, DuplicatesAndImpossibleStatesAreIgnoredAndCounted) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, kThree));
  rig.Run(kBody, kThree, 0.05);
  const std::size_t before = rig.skeletons.size();
  rig.Send(MakeState(kBody, Segment::kHead, rig.clock.Now()));  // the same time again
  body::SegmentState duplicate = MakeState(kBody, Segment::kHead, rig.clock.Now() + 10ms);
  duplicate.verdict = SampleVerdict::kRejectedDuplicate;
  rig.Send(duplicate);
  body::SegmentState not_unit = MakeState(kBody, Segment::kHead, rig.clock.Now() + 10ms);
  not_unit.q_earth_sensor.coeffs() *= std::numeric_limits<double>::quiet_NaN();
  rig.Send(not_unit);
  rig.Advance(1s);
  EXPECT_EQ(rig.skeletons.size(), before);
  EXPECT_EQ(rig.Counted(Count::kStatesIgnored), 3U);
}

TEST(PostureServiceTest, StatesOfUnknownBodiesSegmentsAndSensorsAreCounted) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, kThree));
  rig.Tick(BodyId{9}, {Segment::kPelvis});
  rig.Tick(kBody, {Segment::kLeftHand});
  body::SegmentState other_sensor = MakeState(kBody, Segment::kHead, rig.clock.Now());
  other_sensor.sensor_uid = SensorUid{5};
  rig.Send(other_sensor);
  rig.Advance(1s);
  EXPECT_EQ(rig.Counted(Count::kStatesUnassigned), 3U);
  EXPECT_TRUE(rig.skeletons.empty());
}

TEST(PostureServiceTest, TheFilterThatRunsBesideIsNotHeard) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, {Segment::kPelvis}));
  body::SegmentState beside = MakeState(kBody, Segment::kPelvis, rig.clock.Now());
  beside.slot = 1;
  rig.Send(beside);
  EXPECT_TRUE(rig.skeletons.empty());
  EXPECT_EQ(rig.Counted(Count::kStatesReceived), 0U);
}

TEST(PostureServiceTest, AStreamThatBeginsAnewInThePastIsFollowed) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, kThree));
  rig.Run(kBody, kThree, 0.1);
  const Time back = rig.clock.Now() - 1h;
  const std::size_t before = rig.skeletons.size();
  for (int tick = 0; tick < 10; ++tick) {
    for (const Segment segment : kThree) {
      rig.Send(MakeState(kBody, segment, back + tick * 10ms));
    }
  }
  EXPECT_EQ(rig.skeletons.size(), before + 10);
  EXPECT_TRUE(rig.skeletons.back().complete);
}

TEST(PostureServiceTest, TwoBodiesDoNotDisturbEachOther) {
  PostureRig rig({}, 2);
  const BodyId other{2};
  rig.Roster(MakeRoster(kBody, kThree));
  rig.Roster(MakeRoster(other, {Segment::kPelvis, Segment::kHead}));
  rig.Tick(kBody, {Segment::kPelvis, Segment::kT8});  // incomplete
  rig.Tick(other, {Segment::kPelvis, Segment::kHead});
  ASSERT_EQ(rig.skeletons.size(), 1U);
  EXPECT_EQ(rig.skeletons[0].body_id, other);
  rig.Advance(8ms);
  ASSERT_EQ(rig.skeletons.size(), 2U);
  EXPECT_EQ(rig.skeletons[1].body_id, kBody);
}

TEST(PostureServiceTest, TheSkeletonsDoNotDependOnTheNumberOfWorkers) {
  const auto run = [](std::size_t workers) {
    PostureRig rig({}, workers);
    for (std::uint32_t id = 1; id <= 5; ++id) {
      rig.Roster(MakeRoster(BodyId{id}, kThree));
    }
    for (int tick = 0; tick < 20; ++tick) {
      rig.Advance(10ms);
      for (std::uint32_t id = 1; id <= 5; ++id) {
        rig.Tick(BodyId{id}, kThree, math::ExpSO3({0.01 * tick, 0.1 * id, 0.0}));
      }
    }
    return rig.skeletons;
  };
  const auto one = run(1);
  const auto four = run(4);
  ASSERT_EQ(one.size(), 100U);
  ASSERT_EQ(four.size(), 100U);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].body_id, four[i].body_id);
    for (std::size_t s = 0; s < one[i].segments.size(); ++s) {
      EXPECT_TRUE(one[i].segments[s].q_earth_segment.coeffs() ==
                  four[i].segments[s].q_earth_segment.coeffs());
      EXPECT_TRUE(one[i].segments[s].p_earth_segment_m == four[i].segments[s].p_earth_segment_m);
    }
  }
}

TEST(PostureServiceTest, StageTimesAreThoseOfTheStateThatCompletedTheTick) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, {Segment::kPelvis, Segment::kT8}));
  rig.Send(MakeState(kBody, Segment::kPelvis, rig.clock.Now()));
  rig.Advance(5ms);
  body::SegmentState last = MakeState(kBody, Segment::kT8, rig.clock.Now());
  last.stages.fusion_published_at = rig.clock.Now() + 123us;
  rig.Send(last);
  ASSERT_EQ(rig.skeletons.size(), 1U);
  const body::StageTimes& stages = rig.skeletons[0].stages;
  EXPECT_EQ(stages.gateway_published_at, last.stages.gateway_published_at);
  EXPECT_EQ(stages.fusion_published_at, last.stages.fusion_published_at);
  EXPECT_EQ(stages.posture_received_at, rig.clock.Now());
  EXPECT_EQ(stages.posture_published_at, rig.clock.Now());
}

TEST(PostureServiceTest, AtAFixedRateEverySkeletonIsPredictedToItsInstant) {
  PostureConfig config;
  config.output_rate_hz = 200.0;
  PostureRig rig(config);
  rig.Roster(MakeRoster(kBody, {Segment::kPelvis}));
  const double rate_rad_s = 2.0;
  const Time start = rig.clock.Now();
  for (int ms = 0; ms < 200; ++ms) {
    if (ms % 10 == 0) {  // 100 Hz in
      body::SegmentState state =
          MakeState(kBody, Segment::kPelvis, rig.clock.Now(),
                    math::ExpSO3({0.0, 0.0, rate_rad_s * ToSeconds(rig.clock.Now() - start)}));
      state.w_earth_sensor_in_sensor_rad_s = {0.0F, 0.0F, static_cast<float>(rate_rad_s)};
      rig.Send(state);
    }
    rig.Advance(1ms);
  }
  ASSERT_NEAR(static_cast<double>(rig.skeletons.size()), 40.0, 1.0);
  for (const body::Skeleton& skeleton : rig.skeletons) {
    EXPECT_NEAR(math::Heading_rad(skeleton.segments[0].q_earth_segment.cast<double>()),
                rate_rad_s * ToSeconds(skeleton.measured_at - start), 1e-5);
  }
}

TEST(PostureServiceTest, PredictionIsBoundedAndAFixedRateFallsSilentWithTheLastSensor) {
  PostureConfig config;
  config.output_rate_hz = 100.0;
  PostureRig rig(config);
  rig.Roster(MakeRoster(kBody, {Segment::kPelvis}));
  body::SegmentState state = MakeState(kBody, Segment::kPelvis, rig.clock.Now());
  state.w_earth_sensor_in_sensor_rad_s = {0.0F, 0.0F, 1.0F};
  rig.Send(state);
  for (int i = 0; i < 100; ++i) {
    rig.Advance(10ms);
  }
  EXPECT_EQ(rig.Last(Segment::kPelvis).status, SegmentStatus::kStale);
  EXPECT_NEAR(math::Heading_rad(rig.Last(Segment::kPelvis).q_earth_segment.cast<double>()),
              config.max_extrapolation_s, 1e-6);
  for (int i = 0; i < 300; ++i) {
    rig.Advance(10ms);
  }
  EXPECT_EQ(rig.Last(Segment::kPelvis).status, SegmentStatus::kMissing);
  EXPECT_LT(rig.skeletons.size(), 210U) << "nothing after missing_after_s of silence";
}

TEST(PostureServiceTest, TheRootIsWhereThePositionFixSays) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, kThree));
  rig.Tick(kBody, kThree);
  EXPECT_NEAR(rig.Last(Segment::kPelvis).p_earth_segment_m.z(), 0.530 * 1.75, 1e-6)
      << "without a fix the person stands on the floor";
  sensing::PositionFix fix;
  fix.body_id = kBody;
  fix.p_earth_body_m = {3.0, 4.0, 1.1};
  ASSERT_TRUE(rig.fixes->Write(fix).ok());
  rig.Advance(10ms);
  rig.Tick(kBody, kThree);
  EXPECT_LT(
      (rig.Last(Segment::kPelvis).p_earth_segment_m - Eigen::Vector3f(3.0F, 4.0F, 1.1F)).norm(),
      1e-5F);
}

TEST(PostureServiceTest, TheDefinitionIsPublishedWithEveryChangeAndItsRevisionGrows) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, kThree));
  ASSERT_EQ(rig.definitions.size(), 1U);
  EXPECT_EQ(rig.definitions[0].name, "walker");
  EXPECT_TRUE(rig.definitions[0].segments[0].tracked);
  EXPECT_EQ(rig.definitions[0].segments[0].sensor_uid, UidOf(kBody, Segment::kPelvis));
  EXPECT_FALSE(rig.definitions[0].segments[1].tracked);
  rig.Roster(MakeRoster(kBody, kThree));
  EXPECT_EQ(rig.definitions.size(), 1U) << "no change, no message";
  rig.Tick(kBody, kThree);  // says that heading is magnetic
  ASSERT_EQ(rig.definitions.size(), 2U);
  EXPECT_EQ(rig.definitions[1].heading, HeadingReference::kMagnetic);
  EXPECT_GT(rig.definitions[1].revision, rig.definitions[0].revision);
  EXPECT_EQ(rig.skeletons.back().definition_revision, rig.definitions[1].revision);
}

TEST(PostureServiceTest, APersonWhoLeavesTheRosterIsDisposedAndKeepsTheAlignmentForTheReturn) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, kThree));
  rig.Run(kBody, kThree, 0.5, math::ExpSO3({0.3, 0.0, 0.0}));
  ASSERT_TRUE(rig.Command(kBody, roster::CommandKind::kReferencePose).accepted);
  ASSERT_TRUE(rig.rosters->Dispose(MakeRoster(kBody, {})).ok());
  EXPECT_EQ(rig.gone, std::vector<BodyId>{kBody});
  const std::size_t before = rig.skeletons.size();
  rig.Run(kBody, kThree, 0.1);
  EXPECT_EQ(rig.skeletons.size(), before);
  EXPECT_FALSE(rig.Command(kBody, roster::CommandKind::kReferencePose).accepted);

  rig.Roster(MakeRoster(kBody, kThree));
  EXPECT_TRUE(rig.definitions.back().segments[0].aligned);
  rig.Run(kBody, kThree, 0.1, math::ExpSO3({0.3, 0.0, 0.0}));
  EXPECT_LT(math::AngleBetween_rad(rig.Last(Segment::kT8).q_earth_segment.cast<double>(),
                                   Eigen::Quaterniond::Identity()),
            1e-6);
}

TEST(PostureServiceTest, TheAlignmentSurvivesARestartOfTheFilters) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, kThree));
  const Eigen::Quaterniond mounted = math::ExpSO3({0.3, 0.1, -0.4});
  rig.Run(kBody, kThree, 0.5, mounted);
  ASSERT_TRUE(rig.Command(kBody, roster::CommandKind::kReferencePose).accepted);
  for (const Segment segment : kThree) {  // the filters begin again, with nothing yet
    rig.Advance(10ms);
    body::SegmentState fresh = MakeState(kBody, segment, rig.clock.Now());
    fresh.started = false;
    fresh.verdict = SampleVerdict::kStarting;
    rig.Send(fresh);
  }
  rig.Run(kBody, kThree, 0.1, mounted);
  EXPECT_TRUE(rig.definitions.back().segments[0].aligned);
  EXPECT_LT(math::AngleBetween_rad(rig.Last(Segment::kHead).q_earth_segment.cast<double>(),
                                   Eigen::Quaterniond::Identity()),
            1e-6);
}

TEST(PostureServiceTest, AlignmentAndDimensionsSurviveARestartOfTheService) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / "posture_restart";
  std::filesystem::remove_all(folder);
  PostureConfig config;
  config.state_dir = folder.string();
  const Eigen::Quaterniond mounted = math::ExpSO3({0.3, 0.1, -0.4});
  std::uint32_t revision = 0;
  {
    PostureRig rig(config);
    rig.Roster(MakeRoster(kBody, kThree));
    rig.Run(kBody, kThree, 0.5, mounted);
    ASSERT_TRUE(rig.Command(kBody, roster::CommandKind::kReferencePose).accepted);
    ASSERT_TRUE(rig.Command(kBody, roster::CommandKind::kSetDimensions, "height", {1.9}).accepted);
    revision = rig.definitions.back().revision;
  }
  PostureRig rig(config);
  rig.Roster(MakeRoster(kBody, kThree));
  EXPECT_TRUE(rig.definitions.back().segments[0].aligned);
  EXPECT_GE(rig.definitions.back().revision, revision);
  rig.Run(kBody, kThree, 0.1, mounted);
  EXPECT_LT(math::AngleBetween_rad(rig.Last(Segment::kHead).q_earth_segment.cast<double>(),
                                   Eigen::Quaterniond::Identity()),
            1e-6);
  EXPECT_NEAR(rig.Last(Segment::kPelvis).p_earth_segment_m.z(), 0.530 * 1.9, 1e-6);
  std::filesystem::remove_all(folder);
}

TEST(PostureServiceTest, ABadStateFolderIsRefusedAtStart) {
  PostureConfig config;
  config.state_dir = "/proc/no/such/folder";
  PostureRig rig(config);
  ASSERT_FALSE(rig.started.ok());
  EXPECT_THAT(rig.started.error().message, HasSubstr("posture.state_dir"));
}

TEST(PostureServiceTest, HealthCountsAndMeasures) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, kThree));
  rig.Run(kBody, kThree, 0.1);
  ServiceHealth health;
  rig.service->FillHealth(health);
  const auto value = [&](std::string_view name) {
    for (const NamedValue& v : health.values) {
      if (v.name == name) {
        return v.value;
      }
    }
    return -1.0;
  };
  EXPECT_EQ(value("states.received"), 30.0);
  EXPECT_EQ(value("skeletons"), 10.0);
  EXPECT_EQ(value("skeletons.complete"), 10.0);
  EXPECT_EQ(value("gauge.bodies"), 1.0);
  EXPECT_EQ(value("gauge.state_writers"), 1.0);
  ASSERT_FALSE(health.latencies.empty());
  EXPECT_EQ(health.latencies[0].stage, "sensor_to_posture");
  EXPECT_EQ(health.latencies[0].count, 10U);
  EXPECT_TRUE(health.last_error.empty());
}

TEST(PostureServiceTest, ASteadyStreamDoesNotAllocate) {
  // Through the worker directly: the bus and the recording reader of the rig do allocate.
  const PostureConfig config;
  std::size_t emitted = 0;
  BodyTracker tracker(config, *body::MakeDefaultBody(kBody),
                      [&](const body::Skeleton&, TickEnd, bool) { ++emitted; });
  const std::vector<Segment> all(body::AllSegments().begin(), body::AllSegments().end());
  tracker.SetRoster(MakeRoster(kBody, all));
  Time now = TimeFromNanoseconds(1'700'000'000'000'000'000);
  const auto run = [&](int ticks) {
    for (int i = 0; i < ticks; ++i) {
      now += 10ms;
      for (const Segment segment : body::AllSegments()) {
        StateInput input;
        input.body_id = kBody;
        input.segment = segment;
        input.sensor_uid = UidOf(kBody, segment);
        input.verdict = SampleVerdict::kFused;
        input.started = true;
        input.measured_at = now;
        (void)tracker.OnState(input, now);
      }
      tracker.OnDue(now);
    }
  };
  run(10);
  const std::size_t before = test_support::AllocationCount();
  run(200);
  EXPECT_EQ(test_support::AllocationCount() - before, 0U);
  EXPECT_EQ(emitted, 210U);
}

}  // namespace
}  // namespace limbcast::posture
