#include "services/fusion/sensor_track.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/unit/services/fusion/fusion_fixture.hpp"

namespace limbcast::fusion {
namespace {

using namespace std::chrono_literals;

constexpr SensorUid kSensor{77};
const Time kStart = TimeFromNanoseconds(1'700'000'000'000'000'000);

sensing::MargSample Sample(std::uint32_t sequence) {
  sensing::MargSample sample;
  sample.sensor_uid = kSensor;
  sample.sequence = sequence;
  sample.measured_at = kStart + sequence * kPeriod;
  sample.published_at = sample.measured_at + 1ms;
  sample.gyro_rad_s.x() = 0.01F;
  return sample;
}

class SensorTrackTest : public ::testing::Test {
 protected:
  static TrackPlan Plan(std::string name, std::string beside = "") {
    return {.sensor_uid = kSensor,
            .segment = body::Segment::kHead,
            .filters = {std::move(name), std::move(beside)},
            .overloads = 0};
  }
  SensorTrack::Output Give(const sensing::MargSample& sample, std::uint64_t overloads = 0) {
    return track.Update(sample, {.received_at = sample.measured_at + 2ms, .overloads = overloads});
  }
  const FilterFactory factory = CountingFilters();
  SensorTrack track{BodyId{5}, Plan("tqt"), factory, 1h};
};

TEST_F(SensorTrackTest, AUsedSampleGivesOneStateWithEverythingFilledIn) {
  const auto output = Give(Sample(1));
  ASSERT_EQ(output.states.size(), 1U);
  const body::SegmentState& state = output.states[0];
  EXPECT_EQ(state.body_id, BodyId{5});
  EXPECT_EQ(state.segment, body::Segment::kHead);
  EXPECT_EQ(state.slot, 0);
  EXPECT_EQ(state.sensor_uid, kSensor);
  EXPECT_EQ(state.sequence, 1U);
  EXPECT_EQ(state.verdict, SampleVerdict::kFused);
  EXPECT_TRUE(state.started);
  EXPECT_EQ(state.filter, "tqt");
  EXPECT_EQ(state.measured_at, Sample(1).measured_at);
  EXPECT_EQ(state.stages.gateway_published_at, Sample(1).published_at);
  EXPECT_EQ(state.stages.fusion_received_at, Sample(1).measured_at + 2ms);
  EXPECT_NEAR(math::AngleBetween_rad(state.q_earth_sensor, math::ExpSO3({0.01, 0, 0})), 0.0, 1e-7);
  EXPECT_EQ(state.verdicts[SampleVerdict::kFused], 1U);
}

TEST_F(SensorTrackTest, ADeclinationTurnsWhatIsPublishedToTrueNorth) {
  constexpr double kDeclination_rad = 0.1;  // magnetic north lies east of true north
  SensorTrack turned{BodyId{5}, Plan("bmf"), [](auto name) { return filters::MakeFilter(name); },
                     1h, kDeclination_rad};
  SensorTrack magnetic{BodyId{5}, Plan("bmf"), [](auto name) { return filters::MakeFilter(name); },
                       1h};
  body::SegmentState by_true;
  body::SegmentState by_magnetic;
  for (std::uint32_t i = 1; i <= 100; ++i) {
    sensing::MargSample sample = Sample(i);
    sample.accel_m_s2 = {0.5F, 0.0F, 9.8F};
    sample.mag_tesla = {2e-5F, 0.0F, -4e-5F};
    const Reception reception{.received_at = sample.measured_at + 2ms, .overloads = 0};
    by_true = turned.Update(sample, reception).states[0];
    by_magnetic = magnetic.Update(sample, reception).states[0];
  }
  ASSERT_TRUE(by_true.started);
  EXPECT_EQ(by_magnetic.heading, HeadingReference::kMagnetic);
  EXPECT_EQ(by_true.heading, HeadingReference::kTrue);
  const Eigen::Quaterniond q_true_magnetic = math::ExpSO3({0.0, 0.0, -kDeclination_rad});
  EXPECT_LT(
      math::AngleBetween_rad(by_true.q_earth_sensor, q_true_magnetic * by_magnetic.q_earth_sensor),
      1e-9);
  EXPECT_TRUE(by_true.free_accel_in_earth_m_s2.isApprox(
      q_true_magnetic.cast<float>() * by_magnetic.free_accel_in_earth_m_s2, 1e-5F));
  EXPECT_NEAR(by_true.cov_orientation_rad2.trace(), by_magnetic.cov_orientation_rad2.trace(),
              1e-5F * by_magnetic.cov_orientation_rad2.trace());
}

TEST_F(SensorTrackTest, TheQuaternionIsPublishedWithPositiveW) {
  sensing::MargSample sample = Sample(1);
  sample.gyro_rad_s.x() = 4.0F;  // Exp of more than π about x has w < 0
  EXPECT_GE(Give(sample).states[0].q_earth_sensor.w(), 0.0);
}

TEST_F(SensorTrackTest, AProbeIsAnsweredAndCountedNowhere) {
  Give(Sample(1));
  sensing::MargSample probe = Sample(2);
  probe.sequence = 0;
  probe.flags =
      sensing::kProbe | sensing::kGyroMissing | sensing::kAccelMissing | sensing::kMagMissing;
  const auto output = Give(probe);
  EXPECT_TRUE(output.probe);
  ASSERT_EQ(output.states.size(), 1U);
  EXPECT_EQ(output.states[0].verdict, SampleVerdict::kNoData);
  EXPECT_EQ(output.states[0].verdicts[SampleVerdict::kNoData], 0U);
  EXPECT_EQ(Give(Sample(2)).states[0].verdict, SampleVerdict::kFused) << "not moved by the probe";
}

TEST_F(SensorTrackTest, AProbeBeforeTheFirstSampleIsAnsweredUnstarted) {
  sensing::MargSample probe = Sample(0);
  probe.flags = sensing::kProbe;
  EXPECT_FALSE(Give(probe).states[0].started);
}

TEST_F(SensorTrackTest, EveryRefusalIsAnsweredWithItsVerdictAndLeavesTheOrientation) {
  const Eigen::Quaterniond q = Give(Sample(10)).states[0].q_earth_sensor;
  const auto expect = [&](const sensing::MargSample& sample, SampleVerdict verdict) {
    const auto output = Give(sample);
    ASSERT_EQ(output.states.size(), 1U);
    EXPECT_EQ(output.states[0].verdict, verdict) << ToString(output.states[0].verdict);
    EXPECT_EQ(output.states[0].sequence, sample.sequence);
    EXPECT_TRUE(output.states[0].q_earth_sensor.isApprox(q, 0.0));
  };
  sensing::MargSample not_finite = Sample(11);
  not_finite.gyro_rad_s.y() = std::numeric_limits<float>::quiet_NaN();
  expect(not_finite, SampleVerdict::kRejectedNotFinite);
  expect(Sample(10), SampleVerdict::kRejectedDuplicate);
  sensing::MargSample same_time = Sample(12);
  same_time.measured_at = Sample(10).measured_at;
  expect(same_time, SampleVerdict::kRejectedDuplicate);
  expect(Sample(9), SampleVerdict::kRejectedOutOfOrder);
  sensing::MargSample future = Sample(13);
  future.measured_at = Sample(13).measured_at + 2h;
  const auto refused =
      track.Update(future, {.received_at = Sample(13).measured_at, .overloads = 0});
  EXPECT_EQ(refused.states[0].verdict, SampleVerdict::kRejectedTime);
  sensing::MargSample no_time = Sample(14);
  no_time.measured_at = Time{};
  expect(no_time, SampleVerdict::kRejectedTime);
  sensing::MargSample saturated = Sample(15);
  saturated.flags = sensing::kGyroSaturated;
  expect(saturated, SampleVerdict::kRejectedSaturated);
  sensing::MargSample empty = Sample(16);
  empty.flags = sensing::kGyroMissing;
  expect(empty, SampleVerdict::kNoData);
  EXPECT_EQ(Give(Sample(17)).states[0].verdict, SampleVerdict::kFused);
}

TEST_F(SensorTrackTest, LostSamplesAreCountedByTheNumbers) {
  Give(Sample(1));
  const auto output = Give(Sample(5));
  EXPECT_EQ(output.lost, 3);
  EXPECT_EQ(output.states[0].lost_count, 3U);
  EXPECT_EQ(Give(Sample(3)).states[0].lost_count, 2U) << "one of them was only late";
}

TEST_F(SensorTrackTest, SamplesRefusedForAFullQueueAreOverloadAndNotLost) {
  Give(Sample(1));
  const auto output = Give(Sample(6), 3);  // 2 to 5 are missing, 3 of them were refused
  EXPECT_EQ(output.states[0].verdicts[SampleVerdict::kRejectedOverload], 3U);
  EXPECT_EQ(output.states[0].lost_count, 1U);
}

TEST_F(SensorTrackTest, ANewFilterTakesOverWhenItHasAnOrientation) {
  for (std::uint32_t i = 1; i <= 5; ++i) {
    Give(Sample(i));
  }
  track.Apply(Plan("slow"), factory);  // starts after ten samples
  for (std::uint32_t i = 6; i <= 14; ++i) {
    const auto output = Give(Sample(i));
    EXPECT_EQ(output.states[0].filter, "tqt");
    EXPECT_TRUE(output.states[0].started);
  }
  const auto output = Give(Sample(15));
  EXPECT_EQ(output.states[0].filter, "slow");
  EXPECT_TRUE(output.states[0].started);
}

TEST_F(SensorTrackTest, BeforeAnyOrientationANewFilterIsTakenAtOnce) {
  track.Apply(Plan("slow"), factory);
  EXPECT_EQ(Give(Sample(1)).states[0].filter, "slow");
}

TEST_F(SensorTrackTest, ChoosingTheOldFilterAgainCancelsTheChange) {
  Give(Sample(1));
  track.Apply(Plan("slow"), factory);
  track.Apply(Plan("tqt"), factory);
  for (std::uint32_t i = 2; i <= 30; ++i) {
    EXPECT_EQ(Give(Sample(i)).states[0].filter, "tqt");
  }
}

TEST_F(SensorTrackTest, AFilterBesideGetsTheSameSamplesAndIsSlotOne) {
  track.Apply(Plan("tqt", "slow"), factory);
  for (std::uint32_t i = 1; i <= 10; ++i) {
    const auto output = Give(Sample(i));
    ASSERT_EQ(output.states.size(), 2U);
    EXPECT_EQ(output.states[0].filter, "tqt");
    EXPECT_EQ(output.states[1].filter, "slow");
    EXPECT_EQ(output.states[1].slot, 1);
    EXPECT_EQ(output.states[1].sequence, i);
    EXPECT_EQ(output.states[1].verdict, i < 10 ? SampleVerdict::kStarting : SampleVerdict::kFused);
  }
  track.Apply(Plan("slow"), factory);  // promoted with what it has learned
  const auto output = Give(Sample(11));
  ASSERT_EQ(output.states.size(), 1U);
  EXPECT_EQ(output.states[0].filter, "slow");
  EXPECT_EQ(output.states[0].verdict, SampleVerdict::kFused);
  EXPECT_EQ(output.states[0].slot, 0);
}

TEST_F(SensorTrackTest, AGatewayThatStartsAgainIsFollowed) {
  for (std::uint32_t i = 1; i <= 100; ++i) {
    Give(Sample(i));
  }
  for (std::uint32_t i = 1; i <= 3; ++i) {
    sensing::MargSample sample = Sample(200 + i);
    sample.sequence = i;
    const auto output = Give(sample);
    EXPECT_EQ(output.states[0].verdict, SampleVerdict::kFused);
    EXPECT_EQ(output.states[0].lost_count, 0U);
  }
}

sensing::FusedOrientation Orientation(std::uint32_t sequence) {
  sensing::FusedOrientation orientation;
  orientation.sensor_uid = kSensor;
  orientation.sequence = sequence;
  orientation.measured_at = kStart + sequence * kPeriod;
  orientation.q_earth_sensor = math::ExpSO3({0.0, 0.0, 1.0});
  orientation.heading = HeadingReference::kMagnetic;
  orientation.gyro_rad_s = {0.1F, 0.2F, 0.3F};
  orientation.accel_m_s2 = {1.0F, 0.0F, 9.80665F};
  orientation.sigma_rad = 0.1F;
  return orientation;
}

TEST_F(SensorTrackTest, AnOrientationFromTheSensorPassesThrough) {
  const auto output = track.Update(Orientation(1), {.received_at = kStart, .overloads = 0});
  ASSERT_EQ(output.states.size(), 1U);
  const body::SegmentState& state = output.states[0];
  EXPECT_EQ(state.slot, 0);
  EXPECT_EQ(state.filter, "onboard");
  EXPECT_TRUE(state.started);
  EXPECT_EQ(state.verdict, SampleVerdict::kFused);
  EXPECT_EQ(state.heading, HeadingReference::kMagnetic);
  EXPECT_NEAR(math::AngleBetween_rad(state.q_earth_sensor, math::ExpSO3({0, 0, 1.0})), 0.0, 1e-7);
  EXPECT_EQ(state.w_earth_sensor_in_sensor_rad_s, Orientation(1).gyro_rad_s);
  // 1 m/s² along the sensor's x, which points 1 rad left of east; gravity is taken away.
  const Eigen::Vector3f expected(std::cos(1.0F), std::sin(1.0F), 0.0F);
  EXPECT_TRUE(state.free_accel_in_earth_m_s2.isApprox(expected, 1e-5F));
  EXPECT_FLOAT_EQ(state.cov_orientation_rad2(1, 1), 0.01F);
}

TEST_F(SensorTrackTest, OrientationsAreRefusedLikeSamples) {
  const auto verdict = [&](const sensing::FusedOrientation& orientation) {
    return track.Update(orientation, {.received_at = orientation.measured_at, .overloads = 0})
        .states[0]
        .verdict;
  };
  EXPECT_EQ(verdict(Orientation(10)), SampleVerdict::kFused);
  EXPECT_EQ(verdict(Orientation(10)), SampleVerdict::kRejectedDuplicate);
  EXPECT_EQ(verdict(Orientation(9)), SampleVerdict::kRejectedOutOfOrder);
  sensing::FusedOrientation bad = Orientation(11);
  bad.q_earth_sensor.w() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(verdict(bad), SampleVerdict::kRejectedNotFinite);
  bad = Orientation(12);
  bad.q_earth_sensor.coeffs() *= 2.0;
  EXPECT_EQ(verdict(bad), SampleVerdict::kRejectedNotFinite);
  bad = Orientation(13);
  bad.measured_at = Time{} - 1s;
  EXPECT_EQ(verdict(bad), SampleVerdict::kRejectedTime);
  EXPECT_EQ(verdict(Orientation(14)), SampleVerdict::kFused);
  for (std::uint32_t i = 1; i < 20; ++i) {  // the sensor's clock was set back
    sensing::FusedOrientation old = Orientation(14 + i);
    old.measured_at -= 1h;
    EXPECT_EQ(verdict(old), SampleVerdict::kRejectedOutOfOrder);
  }
  sensing::FusedOrientation accepted = Orientation(34);
  accepted.measured_at -= 1h;
  EXPECT_EQ(verdict(accepted), SampleVerdict::kFused) << "there is a way back";
}

TEST_F(SensorTrackTest, BesideRawSamplesAnOrientationIsSlotOne) {
  Give(Sample(1));
  const auto output = track.Update(Orientation(1), {.received_at = kStart, .overloads = 0});
  ASSERT_EQ(output.states.size(), 1U);
  EXPECT_EQ(output.states[0].slot, 1);
  track.Apply(Plan("tqt", "slow"), factory);
  EXPECT_TRUE(track.Update(Orientation(2), {.received_at = kStart, .overloads = 0}).states.empty())
      << "slot 1 is taken";
}

}  // namespace
}  // namespace limbcast::fusion
