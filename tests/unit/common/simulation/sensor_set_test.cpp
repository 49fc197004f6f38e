#include "common/simulation/sensor_set.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "common/math/rotation.hpp"

namespace limbcast::simulation {
namespace {

using body::Segment;

TEST(SensorSetTest, SetsHoldWhatTheirNamesSay) {
  EXPECT_EQ(SegmentsOf(SensorSet::kReduced15).size(), 15U);
  EXPECT_EQ(SegmentsOf(SensorSet::kStandard17).size(), 17U);
  EXPECT_EQ(SegmentsOf(SensorSet::kAll23).size(), 23U);
  const auto standard = SegmentsOf(SensorSet::kStandard17);
  for (const Segment segment : SegmentsOf(SensorSet::kReduced15)) {
    EXPECT_NE(std::find(standard.begin(), standard.end(), segment), standard.end());
  }
}

TEST(SensorSetTest, MountingsFollowTheirStyle) {
  const auto shape = *MakePersonShape(1.75);
  for (const Segment segment : body::AllSegments()) {
    const auto aligned = MakeMounting(segment, shape, MountingStyle::kAligned, 1);
    const auto rough = MakeMounting(segment, shape, MountingStyle::kRough, 1);
    const auto any = MakeMounting(segment, shape, MountingStyle::kArbitrary, 1);
    const auto again = MakeMounting(segment, shape, MountingStyle::kArbitrary, 1);
    const auto other = MakeMounting(segment, shape, MountingStyle::kArbitrary, 2);
    const auto identity = Eigen::Quaterniond::Identity();
    EXPECT_EQ(aligned.q_segment_sensor.coeffs(), identity.coeffs());
    EXPECT_LT(math::AngleBetween_rad(rough.q_segment_sensor, identity),
              15.01 * std::numbers::pi / 180.0);
    EXPECT_EQ(any.q_segment_sensor.coeffs(), again.q_segment_sensor.coeffs());
    EXPECT_GT(math::AngleBetween_rad(any.q_segment_sensor, other.q_segment_sensor), 0.01);
    EXPECT_LT(any.p_segment_sensor_m.norm(), 0.4);
  }
}

TEST(SensorSetTest, LeftAndRightAreMirrored) {
  const auto shape = *MakePersonShape(1.75);
  const auto right = MakeMounting(Segment::kRightUpperLeg, shape, MountingStyle::kAligned, 1);
  const auto left = MakeMounting(Segment::kLeftUpperLeg, shape, MountingStyle::kAligned, 1);
  EXPECT_NEAR(right.p_segment_sensor_m.y(), -left.p_segment_sensor_m.y(), 1e-12);
  EXPECT_GT(left.p_segment_sensor_m.y(), 0.0);  // on the outside
}

}  // namespace
}  // namespace limbcast::simulation
