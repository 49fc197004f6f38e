#include "common/filters/position/coil_both_sides.hpp"

#include <gtest/gtest.h>

#include "tests/unit/common/filters/position/coil_scene.hpp"

namespace limbcast::filters {
namespace {

using Ticks = std::vector<simulation::CoilTick>;

// The emitter turned upside down: the sensor is on its lower side.
Ticks UpsideDown(Ticks ticks) {
  const Eigen::Quaterniond flip(0.0, 1.0, 0.0, 0.0);  // half a turn about x
  for (simulation::CoilTick& tick : ticks) {
    tick.p_emitter_sensor_m = flip * tick.p_emitter_sensor_m;
    tick.q_sensor_emitter = tick.q_sensor_emitter * flip;
    tick.frame.emitter_gyro_rad_s = flip * tick.frame.emitter_gyro_rad_s;
    tick.frame.emitter_accel_m_s2 = flip * tick.frame.emitter_accel_m_s2;
    // Coils y and z have the other sense now.
    if (tick.frame.drive.coil > 0) {
      tick.frame.drive.current_a = -tick.frame.drive.current_a;
    }
  }
  return ticks;
}

double Error_m(const CoilBothSides& sides, const simulation::CoilTick& tick) {
  return (sides.filter().state().p_emitter_sensor_m() - tick.p_emitter_sensor_m).norm();
}

TEST(CoilBothSidesTest, MotionDecidesOnWhicheverSideTheSensorIs) {
  for (const std::uint64_t seed : {31U, 32U, 33U}) {
    const Ticks upper = SwingingSensor(true, simulation::ThesisPulses(), 10.0, seed);
    for (const Ticks& ticks : {upper, UpsideDown(upper)}) {
      auto sides = CoilBothSides::Make(CoilInertialConfig());
      ASSERT_TRUE(sides);
      int on_the_wrong_side = 0;
      for (const simulation::CoilTick& tick : ticks) {
        sides->Update(tick.frame);
        const Eigen::Vector3d p_m = sides->filter().state().p_emitter_sensor_m();
        on_the_wrong_side += sides->valid() && p_m.dot(tick.p_emitter_sensor_m) < 0.0 ? 1 : 0;
      }
      EXPECT_TRUE(sides->valid());
      EXPECT_EQ(on_the_wrong_side, 0) << "what is called valid is not the mirror image";
      EXPECT_EQ(sides->filter().phase(), CoilPhase::kTracking);
      EXPECT_LT(Error_m(*sides, ticks.back()), 0.02);
    }
  }
}

TEST(CoilBothSidesTest, AtRestNothingIsDecided) {
  const Ticks ticks = SwingingSensor(true, simulation::ThesisPulses(), 2.4, 34);
  auto sides = CoilBothSides::Make(CoilInertialConfig());
  ASSERT_TRUE(sides);
  for (const simulation::CoilTick& tick : ticks) {
    sides->Update(tick.frame);
  }
  EXPECT_FALSE(sides->decided());
}

TEST(CoilBothSidesTest, TheSideIsKeptThroughALoss) {
  const Ticks ticks = UpsideDown(SwingingSensor(true, simulation::ThesisPulses(), 17.0, 35));
  auto sides = CoilBothSides::Make(CoilInertialConfig());
  ASSERT_TRUE(sides);
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    sensing::CoilFrame frame = ticks[k].frame;
    frame.mag_valid = frame.mag_valid && (k < 1000 || k > 1540);  // 4.5 s without: lost
    sides->Update(frame);
  }
  EXPECT_GE(sides->filter().losses(), 1);
  EXPECT_EQ(sides->filter().phase(), CoilPhase::kTracking);
  EXPECT_LT(Error_m(*sides, ticks.back()), 0.03);
}

TEST(CoilBothSidesTest, ABadConfigurationIsRefused) {
  CoilInertialConfig config;
  config.sigma_mag_tesla = -1.0;
  EXPECT_FALSE(CoilBothSides::Make(config));
}

}  // namespace
}  // namespace limbcast::filters
