// Acceptance of issue 4, 2: a simulated walker with sensors turned arbitrarily on 16 segments.
#include "tools/limbcast/person/simulated_trial.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace limbcast::tool {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180.0;

class SimulatedTrialTest : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(SimulatedTrialTest, NineAxesAndTheNPoseAloneStayWithinFourDegreesForFiveMinutes) {
  const SimulatedPersonOptions person{.schedule = MakeCalibrationSchedule(),
                                      .facing_rad = 0.8,
                                      .duration_s = 306.0,
                                      .seed = GetParam()};
  BodyTrialOptions options;
  options.reference_pose_s = 3.0;
  options.facing_rad = person.facing_rad;
  const auto trace = RunSimulatedTrial(person, options, 5.0, 300.0);
  ASSERT_TRUE(trace.ok()) << trace.error().message;
  ASSERT_EQ(trace->windows.size(), 1U);
  EXPECT_LT(trace->windows[0].segment_rms_rad, 4.0 * kDegree_rad);
  EXPECT_LT(trace->windows[0].joint_rms_rad, 4.0 * kDegree_rad);
}

TEST_P(SimulatedTrialTest, SixAxesAfterNPoseAndWalkStayWithinSixDegreesForHalfAnHour) {
  const SimulatedPersonOptions person{.schedule = MakeCalibrationSchedule(),
                                      .duration_s = 1836.0,
                                      .seed = GetParam(),
                                      .magnetometer = false};
  BodyTrialOptions options;
  options.reference_pose_s = 3.0;
  options.walk_until_s = 35.0;  // 30 s of walking
  const auto trace = RunSimulatedTrial(person, options, 36.0, 300.0);
  ASSERT_TRUE(trace.ok()) << trace.error().message;
  ASSERT_TRUE(trace->calibrated) << trace->events.back();
  ASSERT_EQ(trace->windows.size(), 6U);
  for (const TruthErrors& window : trace->windows) {
    EXPECT_LT(window.relative_rms_rad, 6.0 * kDegree_rad) << window.from_s << " s";
  }
  EXPECT_LT(trace->windows.back().relative_rms_rad,
            trace->windows.front().relative_rms_rad + 0.5 * kDegree_rad)
      << "not growing";
}
INSTANTIATE_TEST_SUITE_P(Seeds, SimulatedTrialTest, ::testing::Values(20240517U, 1U, 2U));

TEST(SimulatedTrialAloneTest, WithoutTheHeadingTrackerTheSixAxesDriftApart) {
  const SimulatedPersonOptions person{
      .schedule = MakeCalibrationSchedule(), .duration_s = 940.0, .magnetometer = false};
  BodyTrialOptions options;
  options.reference_pose_s = 3.0;
  options.walk_until_s = 35.0;
  options.posture.heading_tracking = false;
  const auto trace = RunSimulatedTrial(person, options, 36.0, 300.0);
  ASSERT_TRUE(trace.ok());
  EXPECT_GT(trace->windows.back().relative_rms_rad, 6.0 * kDegree_rad)
      << "what the test above shows is the tracker's doing";
}

TEST(SimulatedTrialAloneTest, ThePersonCalibratesByItself) {
  const SimulatedPersonOptions person{
      .schedule = MakeCalibrationSchedule(), .duration_s = 100.0, .magnetometer = false};
  BodyTrialOptions options;
  options.posture.automatic_calibration = true;
  const auto trace = RunSimulatedTrial(person, options, 36.0, 60.0);
  ASSERT_TRUE(trace.ok());
  ASSERT_TRUE(trace->calibrated);
  EXPECT_LT(trace->windows[0].relative_rms_rad, 6.0 * kDegree_rad);
}

}  // namespace
}  // namespace limbcast::tool
