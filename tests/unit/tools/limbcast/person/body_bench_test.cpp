#include "tools/limbcast/person/body_bench.hpp"

#include <gtest/gtest.h>

#include "common/math/rotation.hpp"

namespace limbcast::tool {
namespace {

using body::Segment;

sensing::MargSample AtRest(SensorUid uid, double time_s) {
  sensing::MargSample sample;
  sample.sensor_uid = uid;
  sample.measured_at = Time{} + std::chrono::hours(1) + DurationFromSeconds(time_s);
  sample.accel_m_s2 = Eigen::Vector3f(0.0F, 9.81F, 0.0F);  // lies on its side
  sample.flags = sensing::kMagMissing;
  return sample;
}

TEST(BodyBenchTest, SamplesBecomeSkeletonsAndThePoseStandsThemUp) {
  BodyTrialOptions options;
  options.reference_pose_s = 1.0;
  const std::vector<roster::SensorAssignment> sensors{{SensorUid{1}, Segment::kPelvis},
                                                      {SensorUid{2}, Segment::kHead}};
  body::Skeleton last;
  std::size_t count = 0;
  auto bench = BodyBench::Make(options, sensors, [&](const body::Skeleton& skeleton) {
    last = skeleton;
    ++count;
  });
  ASSERT_TRUE(bench.ok()) << bench.error().message;
  for (int i = 0; i < 200; ++i) {
    const double time_s = i * 0.01;
    (*bench)->Feed(AtRest(SensorUid{1}, time_s));
    (*bench)->Feed(AtRest(SensorUid{2}, time_s));
    (*bench)->Feed(AtRest(SensorUid{99}, time_s));  // nobody's
    (*bench)->EndTick(Time{} + std::chrono::hours(1) + DurationFromSeconds(time_s), time_s);
  }
  EXPECT_GE(count, 150U) << "the filters take their start from the first half second";
  EXPECT_TRUE((*bench)->calibrated());
  ASSERT_EQ((*bench)->events().size(), 1U);
  EXPECT_EQ((*bench)->events()[0], "1.00 s: aligned 2 segments, n_pose, facing 0.0 deg");
  EXPECT_LT(math::AngleBetween_rad(last.segments[0].q_earth_segment.cast<double>(),
                                   Eigen::Quaterniond::Identity()),
            0.01);
  EXPECT_TRUE((*bench)->Definition().segments[0].aligned);
}

TEST(BodyBenchTest, AnUnknownFilterIsRefused) {
  BodyTrialOptions options;
  options.filter = "no such";
  EXPECT_FALSE(BodyBench::Make(options, {}, [](const body::Skeleton&) {}).ok());
}

}  // namespace
}  // namespace limbcast::tool
