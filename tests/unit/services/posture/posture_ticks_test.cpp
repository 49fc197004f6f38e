// Which states make which skeleton, and when: the service seen from outside, the clock by hand.

#include <gtest/gtest.h>

#include "common/math/rotation.hpp"
#include "tests/unit/services/posture/posture_rig.hpp"

namespace limbcast::posture {
namespace {

using body::Segment;
using body::SegmentStatus;
using namespace std::chrono_literals;

constexpr BodyId kBody{1};
const std::vector<Segment> kThree = {Segment::kPelvis, Segment::kT8, Segment::kHead};

TEST(PostureTicksTest, ACompleteTickIsEmittedAtOnceWithoutWaiting) {
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

TEST(PostureTicksTest, EveryTickGivesOneSkeletonAndNoneTwice) {
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

TEST(PostureTicksTest, AMissingStateIsWaitedForUntilTheDeadlineAndThenSaidToBeStale) {
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

TEST(PostureTicksTest, ALateStateIsCountedAndEmitsNothing) {
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

TEST(PostureTicksTest, AVanishedSensorBecomesStaleThenMissingAndTheBodyGoesOnWithoutWaiting) {
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

TEST(PostureTicksTest, ProbesOfSegmentsThatHaveNotStartedGiveASkeletonOfMissingSegments) {
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

TEST(PostureTicksTest, ASensorThatNeverSpeaksCostsTheDeadlineOnlyAtFirst) {
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

TEST(PostureTicksTest, SensorsThatSampleAtDifferentInstantsMakeOneSkeletonAPeriod) {
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

TEST(PostureTicksTest, AnEarlierMeasurementIsTurnedOnToTheInstantOfTheSkeleton) {
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

TEST(PostureTicksTest, ALostSampleInAFastReplayEndsTheTickWhenTheNextOneOvertakes) {
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

TEST(PostureTicksTest, ARefusedSampleAnswersTheTickButIsNotAMeasurement) {
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

TEST(PostureTicksTest, DuplicatesAndImpossibleStatesAreIgnoredAndCounted) {
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

TEST(PostureTicksTest, AStreamThatBeginsAnewInThePastIsFollowed) {
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

TEST(PostureTicksTest, AtAFixedRateEverySkeletonIsPredictedToItsInstant) {
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

TEST(PostureTicksTest, PredictionIsBoundedAndAFixedRateFallsSilentWithTheLastSensor) {
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

}  // namespace
}  // namespace limbcast::posture
