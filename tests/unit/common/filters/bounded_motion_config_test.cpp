#include "common/filters/bounded_motion_config.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace limbcast::filters {
namespace {

TEST(BoundedMotionConfigTest, ShippedDefaultsAreValid) {
  EXPECT_TRUE(Validate(BoundedMotionConfig()).ok());
  EXPECT_TRUE(Validate(PlainBoundedMotionConfig()).ok());
}

TEST(BoundedMotionConfigTest, AnUnboundedSensorIsAllowed) {
  BoundedMotionConfig config;
  config.velocity_bound_m_s_rts = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(Validate(config).ok());
}

TEST(BoundedMotionConfigTest, ThePlainFilterHasNoElementOfTheGuard) {
  const BoundedMotionConfig plain = PlainBoundedMotionConfig();
  EXPECT_FALSE(plain.mag_heading_only);
  EXPECT_EQ(plain.scatter_floor_ref, std::numeric_limits<double>::infinity());
  EXPECT_EQ(plain.position_persistence_s, 0.0);
  EXPECT_EQ(plain.rest_turn_persistence_s, 0.0);
  EXPECT_EQ(plain.walk_reference_ref_rts, 0.0);
  EXPECT_EQ(plain.sigma_time_s, 0.0);
}

TEST(BoundedMotionConfigTest, ARefusalNamesFieldValueAndRange) {
  BoundedMotionConfig config;
  config.slow_rate_hz = 0.0;
  const Status status = Validate(config);
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().message.find("bmf.slow_rate_hz must be in [5, 100]"), std::string::npos)
      << status.error().message;
}

TEST(BoundedMotionConfigTest, EveryFieldRefusesNotANumber) {
  for (const auto& field : BoundedMotionFields()) {
    if (!field.choices.empty()) {
      continue;
    }
    BoundedMotionConfig config;
    field.set(config, std::numeric_limits<double>::quiet_NaN());
    EXPECT_FALSE(Validate(config).ok()) << field.name;
  }
}

}  // namespace
}  // namespace limbcast::filters
