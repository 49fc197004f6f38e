#include "common/filters/position/coil_hypotheses.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/common/filters/position/coil_scene.hpp"

namespace limbcast::filters {
namespace {

CoilInertialConfig WithoutHalfSpace() {
  CoilInertialConfig config = SwingConfig();
  config.half_space.reset();
  return config;
}

// Turns source and sensor so that the sensor is on the other side of the source: only the axes of
// the source differ, by half a turn about x. (p_M = (x, y, z) becomes (x, −y, −z).)
simulation::CoilTick OtherSide(simulation::CoilTick tick) {
  for (Eigen::Vector3d* v :
       {&tick.frame.emitter_gyro_rad_s, &tick.frame.emitter_accel_m_s2, &tick.p_emitter_sensor_m}) {
    v->y() = -v->y();
    v->z() = -v->z();
  }
  if (tick.frame.drive.coil > 0) {
    tick.frame.drive.current_a = -tick.frame.drive.current_a;
  }
  return tick;
}

struct Outcome {
  double decided_s = -1.0;
  double worst_m = 0.0;  // of what was valid, from a second after the decision on
  int wrong_side = 0;
  int valid = 0;
};

Outcome Run(const CoilInertialConfig& config, bool other_side, std::uint64_t seed) {
  auto hypotheses = CoilHypotheses::Make(config);
  EXPECT_TRUE(hypotheses);
  Outcome outcome;
  for (const simulation::CoilTick& given :
       SwingingSensor(true, simulation::ThesisPulses(), 12.0, seed)) {
    const simulation::CoilTick tick = other_side ? OtherSide(given) : given;
    const double t_s = ToSeconds(tick.frame.measured_at.time_since_epoch());
    hypotheses->Update(tick.frame);
    if (hypotheses->valid() && outcome.decided_s < 0.0) {
      outcome.decided_s = t_s;
    }
    if (hypotheses->valid()) {
      ++outcome.valid;
      const Eigen::Vector3d p_m = hypotheses->filter().state().p_emitter_sensor_m();
      outcome.wrong_side += p_m.dot(tick.p_emitter_sensor_m) < 0.0 ? 1 : 0;
      if (t_s > outcome.decided_s + 1.0) {
        outcome.worst_m = std::max(outcome.worst_m, (p_m - tick.p_emitter_sensor_m).norm());
      }
    }
  }
  return outcome;
}

TEST(CoilHypothesesTest, MotionTellsTheTwoSidesApart) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    for (const bool other_side : {false, true}) {
      const Outcome outcome = Run(WithoutHalfSpace(), other_side, seed);
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", other side " << other_side);
      EXPECT_GT(outcome.decided_s, 2.5) << "still until then: nobody could know";
      EXPECT_LT(outcome.decided_s, 7.5) << "within 5 s of motion";
      EXPECT_EQ(outcome.wrong_side, 0);
      EXPECT_LT(outcome.worst_m, 0.06);
      EXPECT_GT(outcome.valid, 300);
    }
  }
}

TEST(CoilHypothesesTest, AConfiguredHalfSpaceIsBelievedAtOnce) {
  const Outcome outcome = Run(SwingConfig(), false, 1);
  EXPECT_GT(outcome.decided_s, 0.0);
  EXPECT_LT(outcome.decided_s, 2.5);
  EXPECT_EQ(outcome.wrong_side, 0);
}

TEST(CoilHypothesesTest, MirroredTwiceItIsTheSameFilter) {
  auto filter = CoilInertialFilter::Make(SwingConfig());
  for (const simulation::CoilTick& tick :
       SwingingSensor(true, simulation::ThesisPulses(), 5.0, 5)) {
    filter->Update(tick.frame);
  }
  ASSERT_EQ(filter->phase(), CoilPhase::kTracking);
  CoilInertialFilter twice = *filter;
  twice.Mirror();
  EXPECT_EQ(twice.state().p_earth_m, -filter->state().p_earth_m);
  EXPECT_NE(twice.covariance(), filter->covariance());
  twice.Mirror();
  EXPECT_EQ(twice.state().p_earth_m, filter->state().p_earth_m);
  EXPECT_EQ(twice.covariance(), filter->covariance());
}

}  // namespace
}  // namespace limbcast::filters
