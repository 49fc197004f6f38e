#include "common/body/ground_contact.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace limbcast::body {
namespace {

GroundContact After(const GroundContactInput& input, int frames = 100) {
  GroundContact contact;
  for (int i = 0; i < frames; ++i) {
    contact.Observe(input);
  }
  return contact;
}

GroundContact Touching() {
  GroundContact contact = After({});
  contact.Decide(0.0);
  EXPECT_TRUE(contact.touches());
  return contact;
}

TEST(GroundContactTest, AStillPointOnTheGroundIsFullyTrusted) {
  EXPECT_DOUBLE_EQ(Touching().trust(), 1.0);
  EXPECT_DOUBLE_EQ(Touching().unrest(), 0.0);
}

TEST(GroundContactTest, HeightHasHysteresis) {
  const GroundContactConfig config;
  const double between_m = 0.5 * (config.height_on_m + config.height_off_m);
  GroundContact coming_down = After({.height_m = between_m});
  coming_down.Decide(0.0);
  EXPECT_FALSE(coming_down.touches());
  GroundContact lifting = Touching();
  lifting.Observe({.height_m = between_m});
  lifting.Decide(0.0);
  EXPECT_TRUE(lifting.touches());
  lifting.Observe({.height_m = config.height_off_m});
  lifting.Decide(0.0);
  EXPECT_FALSE(lifting.touches());
  EXPECT_EQ(lifting.trust(), 0.0);
}

TEST(GroundContactTest, SpeedHasHysteresis) {
  const GroundContactConfig config;
  const double between_m_s = 0.5 * (config.speed_on_m_s + config.speed_off_m_s);
  GroundContact contact;
  contact.Decide(between_m_s);
  EXPECT_FALSE(contact.touches());
  contact.Decide(0.0);
  contact.Decide(between_m_s);
  EXPECT_TRUE(contact.touches());
  contact.Decide(config.speed_off_m_s);
  EXPECT_FALSE(contact.touches());
}

TEST(GroundContactTest, TrustFallsSmoothlyToZeroAsThePointRises) {
  GroundContact contact = Touching();
  double last = 1.0;
  for (double height_m = 0.0; height_m < GroundContactConfig{}.height_off_m; height_m += 1e-4) {
    contact.Observe({.height_m = height_m});
    contact.Decide(0.0);
    EXPECT_LE(contact.trust(), last);
    EXPECT_GT(contact.trust(), last - 0.01);
    last = contact.trust();
  }
  EXPECT_LT(last, 0.01);
}

TEST(GroundContactTest, RateAccelerationAndHeightAreUnrest) {
  const GroundContactConfig config;
  EXPECT_NEAR(After({.rate_rad_s = config.restless_rate_rad_s}).unrest(), 1.0, 1e-9);
  EXPECT_NEAR(After({.accel_m_s2 = 2.0 * config.restless_accel_m_s2}).unrest(), 4.0, 1e-9);
  EXPECT_NEAR(After({.height_m = config.restless_height_m}).unrest(), 1.0, 1e-9);
  GroundContact turning = After({.rate_rad_s = config.restless_rate_rad_s});
  turning.Decide(0.0);
  EXPECT_NEAR(turning.trust(), 0.5, 1e-9);
}

TEST(GroundContactTest, UnrestFollowsWithinItsTimeConstant) {
  const GroundContactConfig config;
  // After one time constant 1 − 1/e of the way, at any rate of frames.
  for (const int frames : {4, 8, 40}) {
    const GroundContact contact = After(
        {.rate_rad_s = config.restless_rate_rad_s, .dt_s = config.smoothing_s / frames}, frames);
    EXPECT_NEAR(contact.unrest(), 1.0 - std::exp(-1.0), 1e-9);
  }
}

TEST(GroundContactTest, ARateThatIsNoNumberIsNotKnown) {
  GroundContact contact = After({.rate_rad_s = std::numeric_limits<double>::quiet_NaN()}, 1);
  contact.Decide(0.0);
  EXPECT_DOUBLE_EQ(contact.trust(), 1.0);
}

TEST(GroundContactTest, ResetForgetsTheContact) {
  GroundContact contact = Touching();
  contact.Reset();
  EXPECT_FALSE(contact.touches());
  EXPECT_EQ(contact.trust(), 0.0);
}

}  // namespace
}  // namespace limbcast::body
