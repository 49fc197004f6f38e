#include "common/filters/rest_detector.hpp"

#include <gtest/gtest.h>

namespace limbcast::filters {
namespace {

using Eigen::Vector3d;

constexpr double kStep_s = 0.01;
const Vector3d kUp_m_s2(0.0, 0.0, 9.81);

void Feed(RestDetector& detector, double seconds, const Vector3d& gyro_rad_s,
          const Vector3d& accel_m_s2 = kUp_m_s2) {
  for (int i = 0; i < static_cast<int>(seconds / kStep_s + 0.5); ++i) {
    detector.Update(gyro_rad_s, accel_m_s2, Vector3d::Zero(), kStep_s);
  }
}

TEST(RestDetectorTest, RestIsReachedAfterOneAndAHalfSecondsAndNotBefore) {
  RestDetector detector;
  Feed(detector, 1.45, Vector3d(0.01, 0.0, 0.0));
  EXPECT_FALSE(detector.at_rest());
  Feed(detector, 0.10, Vector3d(0.01, 0.0, 0.0));
  EXPECT_TRUE(detector.at_rest());
  EXPECT_NEAR(detector.low_gyro_rad_s().x(), 0.01, 1e-6);
}

TEST(RestDetectorTest, ASteadyRotationIsNotRest) {
  RestDetector detector;
  Feed(detector, 5.0, Vector3d(0.05, 0.0, 0.0));  // 2.9 °/s
  EXPECT_FALSE(detector.at_rest());
}

TEST(RestDetectorTest, AJerkOfEitherSensorEndsRest) {
  RestDetector detector;
  Feed(detector, 3.0, Vector3d::Zero());
  ASSERT_TRUE(detector.at_rest());
  Feed(detector, kStep_s, Vector3d(0.1, 0.0, 0.0));
  EXPECT_FALSE(detector.at_rest());
  Feed(detector, 3.0, Vector3d::Zero());
  ASSERT_TRUE(detector.at_rest());
  Feed(detector, kStep_s, Vector3d::Zero(), kUp_m_s2 + Vector3d(0.6, 0.0, 0.0));
  EXPECT_FALSE(detector.at_rest());
}

TEST(RestDetectorTest, AMissingChannelInterrupts) {
  RestDetector detector;
  Feed(detector, 3.0, Vector3d::Zero());
  detector.Interrupt();
  EXPECT_FALSE(detector.at_rest());
  EXPECT_EQ(detector.still_s(), 0.0);
}

}  // namespace
}  // namespace limbcast::filters
