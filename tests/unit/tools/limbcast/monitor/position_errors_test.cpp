#include "tools/limbcast/monitor/position_errors.hpp"

#include <gtest/gtest.h>

#include "common/math/rotation.hpp"

namespace limbcast::tool {
namespace {

using body::Segment;

constexpr Time kStart = TimeFromNanoseconds(1'700'000'000'000'000'000);
constexpr int kTicks = 300;

Time At(int tick) { return kStart + tick * std::chrono::milliseconds(10); }

body::SegmentTruth Truth(int tick, Segment segment, const Eigen::Vector3d& p_m,
                         const Eigen::Quaterniond& q = Eigen::Quaterniond::Identity()) {
  body::SegmentTruth truth;
  truth.body_id = BodyId{1};
  truth.segment = segment;
  truth.measured_at = At(tick);
  truth.segment_valid = true;
  truth.q_earth_sensor = q;
  truth.p_earth_sensor_m = p_m;
  truth.p_earth_segment_m = p_m;
  return truth;
}

body::SegmentState State(int tick, Segment segment,
                         const Eigen::Quaterniond& q = Eigen::Quaterniond::Identity()) {
  body::SegmentState state;
  state.body_id = BodyId{1};
  state.segment = segment;
  state.measured_at = At(tick);
  state.verdict = SampleVerdict::kFused;
  state.started = true;
  state.q_earth_sensor = q;
  return state;
}

TEST(PositionErrorsTest, CoilsAreJudgedInTheAxesOfTheSource) {
  PositionErrors errors;
  errors.CountFrom(kStart);
  const Eigen::Quaterniond q = math::ExpSO3({0.1, 0.2, 0.3});
  const Eigen::Quaterniond q_estimated = math::ExpSO3({0.0, 0.0, 0.4}) * q;  // no matter
  for (int tick = 0; tick < kTicks; ++tick) {
    body::SegmentState wrist = State(tick, Segment::kLeftForeArm);
    wrist.has_position = true;
    wrist.position_reference = PositionReference::kSensor;
    wrist.position_from = Segment::kPelvis;
    wrist.p_earth_sensor_m = (q_estimated * Eigen::Vector3d(0.3, 0.01, 0.0)).cast<float>();
    wrist.cov_position_m2 = 4e-4F / 3.0F * Eigen::Matrix3f::Identity();
    // In any order: truth last.
    errors.AddSegmentState(wrist);
    errors.AddSegmentState(State(tick, Segment::kPelvis, q_estimated));
    errors.AddTruth(Truth(tick, Segment::kPelvis, {5.0, 5.0, 1.0}, q));
    errors.AddTruth(Truth(tick, Segment::kLeftForeArm,
                          Eigen::Vector3d(5.0, 5.0, 1.0) + q * Eigen::Vector3d(0.3, 0.0, 0.0)));
  }
  const auto& wrist = errors.sensors().at({BodyId{1}, Segment::kLeftForeArm});
  EXPECT_GT(wrist.count, 100U);
  EXPECT_NEAR(wrist.rms_m, 0.01, 1e-6);
  EXPECT_NEAR(wrist.max_m, 0.01, 1e-6);
  EXPECT_NEAR(wrist.sigma_m, 0.02, 1e-6);
}

TEST(PositionErrorsTest, LaggedStatesAreJudgedApartAndAgainstTheirOwnTime) {
  constexpr int kLag = 50;
  PositionErrors errors;
  errors.CountFrom(kStart);
  for (int tick = 0; tick < kTicks; ++tick) {
    errors.AddTruth(Truth(tick, Segment::kPelvis, {0.1 * tick, 0.0, 0.0}));
    body::SegmentState live = State(tick, Segment::kPelvis);
    live.has_position = true;
    live.p_earth_sensor_m.x() = 0.1F * static_cast<float>(tick) + 0.005F;
    errors.AddSegmentState(live);
    if (tick >= kLag) {
      body::SegmentState lagged = State(tick - kLag, Segment::kPelvis);
      lagged.slot = body::kLaggedSlot;
      lagged.has_position = true;
      lagged.p_earth_sensor_m.x() = 0.1F * static_cast<float>(tick - kLag) + 0.001F;
      errors.AddSegmentState(lagged);
    }
  }
  EXPECT_NEAR(errors.sensors().at({BodyId{1}, Segment::kPelvis}).rms_m, 0.005, 1e-5);
  const auto& lagged = errors.lagged().at({BodyId{1}, Segment::kPelvis});
  EXPECT_NEAR(lagged.rms_m, 0.001, 1e-5);
  EXPECT_GT(lagged.count, 100U);
}

TEST(PositionErrorsTest, MarkersAreJudgedInTheEarthFrameAndOnlyFromWhenItCounts) {
  PositionErrors errors;
  errors.CountFrom(At(100));
  for (int tick = 0; tick < kTicks; ++tick) {
    body::SegmentState pelvis = State(tick, Segment::kPelvis);
    pelvis.has_position = true;
    pelvis.p_earth_sensor_m.x() = tick < 100 ? 9.0F : 1.002F;
    errors.AddTruth(Truth(tick, Segment::kPelvis, {1.0, 0.0, 0.0}));
    errors.AddSegmentState(pelvis);
  }
  const auto& pelvis = errors.sensors().at({BodyId{1}, Segment::kPelvis});
  EXPECT_NEAR(pelvis.max_m, 0.002, 1e-6);
  EXPECT_LE(pelvis.count, 100U);
}

TEST(PositionErrorsTest, LimbsOfTheSkeletonAreJudgedAgainstThePelvis) {
  PositionErrors errors;
  errors.CountFrom(kStart);
  for (int tick = 0; tick < kTicks; ++tick) {
    errors.AddTruth(Truth(tick, Segment::kPelvis, {1.0, 0.0, 1.0}));
    errors.AddTruth(Truth(tick, Segment::kLeftHand, {1.0, 0.3, 1.0}));
    body::Skeleton skeleton;
    skeleton.body_id = BodyId{1};
    skeleton.measured_at = At(tick);
    skeleton.segments = {{.segment = Segment::kPelvis, .p_earth_segment_m = {1.5F, 0.0F, 1.0F}},
                         {.segment = Segment::kLeftHand, .p_earth_segment_m = {1.5F, 0.32F, 1.0F}}};
    errors.AddSkeleton(skeleton);
  }
  EXPECT_NEAR(errors.joints().at({BodyId{1}, Segment::kPelvis}).rms_m, 0.5, 1e-6);
  EXPECT_NEAR(errors.joints().at({BodyId{1}, Segment::kLeftHand}).rms_m, 0.02, 1e-6);
}

TEST(PositionErrorsTest, WithoutPositionsThereIsNothingToJudge) {
  PositionErrors errors;
  errors.CountFrom(kStart);
  for (int tick = 0; tick < kTicks; ++tick) {
    errors.AddTruth(Truth(tick, Segment::kPelvis, {}));
    errors.AddSegmentState(State(tick, Segment::kPelvis));
  }
  EXPECT_TRUE(errors.sensors().empty());
}

}  // namespace
}  // namespace limbcast::tool
