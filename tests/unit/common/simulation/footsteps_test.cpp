#include "common/simulation/footsteps.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace limbcast::simulation {
namespace {

struct Fixture {
  PersonShape shape = *MakePersonShape(1.75);
  Timeline timeline = *Timeline::Make(MakeDefaultSchedule());
  const TimedPhase& walk = *timeline.At(10.0).phase;
  Footsteps footsteps{walk, shape};
};

TEST(FootstepsTest, BeginsAndEndsUnderTheHips) {
  const Fixture f;
  for (const auto& [since_s, place] :
       {std::pair{0.0, f.walk.from}, std::pair{f.walk.duration_s(), f.walk.to}}) {
    for (const Side side : {Side::kRight, Side::kLeft}) {
      const FootMotion foot = f.footsteps.At(f.walk, side, Jet::Variable(since_s));
      const double out = side == Side::kLeft ? 1.0 : -1.0;
      const FloorPose expected = Compose(place, {0.0, out * f.shape.hip_half_m, 0.0});
      EXPECT_NEAR(foot.p_earth_ankle_m.x.value, expected.x_m, 1e-9);
      EXPECT_NEAR(foot.p_earth_ankle_m.y.value, expected.y_m, 1e-9);
      EXPECT_NEAR(foot.p_earth_ankle_m.z.value, f.shape.ankle_height_m, 1e-9);
      EXPECT_NEAR(foot.pitch_rad.value, 0.0, 1e-9);
      EXPECT_TRUE(foot.contact);
    }
  }
}

TEST(FootstepsTest, HasContinuousDerivatives) {
  const Fixture f;
  constexpr double kStep_s = 1e-5;
  for (double t_s = 0.01; t_s < f.walk.duration_s(); t_s += 0.0173) {
    const auto z = [&](double at_s) {
      return f.footsteps.At(f.walk, Side::kLeft, Jet::Variable(at_s)).p_earth_ankle_m;
    };
    const Jet3 before = z(t_s - kStep_s);
    const Jet3 at = z(t_s);
    const Jet3 after = z(t_s + kStep_s);
    EXPECT_NEAR((after.x.value - before.x.value) / (2.0 * kStep_s), at.x.rate, 1e-5);
    EXPECT_NEAR((after.z.value - before.z.value) / (2.0 * kStep_s), at.z.rate, 1e-5);
    EXPECT_NEAR((after.z.rate - before.z.rate) / (2.0 * kStep_s), at.z.accel, 0.02);
  }
}

TEST(FootstepsTest, OneFootAlwaysRestsAndBothSwing) {
  const Fixture f;
  int in_air = 0;
  int samples = 0;
  for (double t_s = 0.0; t_s < f.walk.duration_s(); t_s += 0.01) {
    const bool right = f.footsteps.At(f.walk, Side::kRight, Jet::Variable(t_s)).contact;
    const bool left = f.footsteps.At(f.walk, Side::kLeft, Jet::Variable(t_s)).contact;
    EXPECT_TRUE(right || left) << "at " << t_s;
    in_air += right ? 0 : 1;
    ++samples;
  }
  EXPECT_NEAR(static_cast<double>(in_air) / samples, 0.4, 0.04);  // swing is 40 % of the stride
}

}  // namespace
}  // namespace limbcast::simulation
