#include "tools/limbcast/monitor/orientation_errors.hpp"

#include <gtest/gtest.h>

#include "common/math/rotation.hpp"

namespace limbcast::tool {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

Time At(double seconds) { return Time{DurationFromSeconds(seconds)}; }
Quaterniond Yaw(double angle_rad) { return math::ExpSO3(angle_rad * Vector3d::UnitZ()); }

body::SegmentTruth Truth(double at_s, const Quaterniond& q, bool segment_valid = true) {
  body::SegmentTruth truth;
  truth.measured_at = At(at_s);
  truth.sensor_valid = true;
  truth.segment_valid = segment_valid;
  truth.q_earth_segment = q;
  truth.q_earth_sensor = q;
  return truth;
}

body::Skeleton Pose(double at_s, const Quaterniond& q,
                    body::SegmentStatus status = body::SegmentStatus::kTracked) {
  body::Skeleton skeleton;
  skeleton.measured_at = At(at_s);
  skeleton.segments.push_back({.segment = body::Segment::kPelvis,
                               .status = status,
                               .confidence = 1.0F,
                               .q_earth_segment = q.cast<float>()});
  return skeleton;
}

TEST(OrientationErrorsTest, IsTheAngleToTheTruthOfTheSameInstant) {
  OrientationErrors errors;
  errors.CountFrom(At(0.0));
  errors.AddTruth(Truth(1.00, Yaw(0.3)));
  errors.AddSkeleton(Pose(1.00, Yaw(0.4)));
  errors.AddTruth(Truth(1.01, Yaw(0.5)));
  errors.AddSkeleton(Pose(1.01, Yaw(0.2)));

  const auto summary = errors.Get();
  ASSERT_TRUE(summary.has_value());
  EXPECT_EQ(summary->count, 2U);
  EXPECT_NEAR(summary->rms_rad, std::sqrt((0.01 + 0.09) / 2), 1e-6);
  EXPECT_NEAR(summary->max_rad, 0.3, 1e-6);
}

TEST(OrientationErrorsTest, TruthMayComeLaterAndIsInterpolated) {
  OrientationErrors errors;
  errors.CountFrom(At(0.0));
  errors.AddSkeleton(Pose(1.005, Yaw(0.45)));
  errors.AddTruth(Truth(1.00, Yaw(0.4)));
  EXPECT_FALSE(errors.Get().has_value());
  errors.AddTruth(Truth(1.01, Yaw(0.5)));
  ASSERT_TRUE(errors.Get().has_value());
  EXPECT_NEAR(errors.Get()->max_rad, 0.0, 1e-6);
}

TEST(OrientationErrorsTest, NothingCountsBeforeItsTime) {
  OrientationErrors errors;
  errors.AddTruth(Truth(1.00, Yaw(0.0)));
  errors.AddSkeleton(Pose(1.00, Yaw(1.0)));
  EXPECT_FALSE(errors.Get().has_value());
  errors.CountFrom(At(2.0));
  errors.AddTruth(Truth(1.50, Yaw(0.0)));
  errors.AddSkeleton(Pose(1.50, Yaw(1.0)));
  EXPECT_FALSE(errors.Get().has_value());
}

TEST(OrientationErrorsTest, OnlyTrackedSegmentsAreJudged) {
  OrientationErrors errors;
  errors.CountFrom(At(0.0));
  errors.AddTruth(Truth(1.00, Yaw(0.0)));
  errors.AddSkeleton(Pose(1.00, Yaw(1.0), body::SegmentStatus::kStale));
  errors.AddSkeleton(Pose(1.00, Yaw(1.0), body::SegmentStatus::kMissing));
  EXPECT_FALSE(errors.Get().has_value());
}

TEST(OrientationErrorsTest, SensorsAreJudgedWhereOnlyTheyAreKnown) {
  body::SegmentState state;
  state.started = true;
  state.verdict = SampleVerdict::kFused;
  state.measured_at = At(1.0);
  state.q_earth_sensor = Yaw(0.2);

  OrientationErrors with_segments;
  with_segments.CountFrom(At(0.0));
  with_segments.AddTruth(Truth(1.0, Yaw(0.0)));
  with_segments.AddSegmentState(state);
  EXPECT_FALSE(with_segments.Get().has_value());

  OrientationErrors sensors_only;
  sensors_only.CountFrom(At(0.0));
  sensors_only.AddTruth(Truth(1.0, Yaw(0.0), false));
  sensors_only.AddSegmentState(state);
  ASSERT_TRUE(sensors_only.Get().has_value());
  EXPECT_NEAR(sensors_only.Get()->max_rad, 0.2, 1e-6);
}

TEST(OrientationErrorsTest, AGapInTheTruthIsNotBridged) {
  OrientationErrors errors;
  errors.CountFrom(At(0.0));
  errors.AddTruth(Truth(1.0, Yaw(0.0)));
  errors.AddTruth(Truth(1.2, Yaw(0.0)));
  errors.AddSkeleton(Pose(1.1, Yaw(1.0)));
  EXPECT_FALSE(errors.Get().has_value());
}

}  // namespace
}  // namespace limbcast::tool
