#include "tools/limbcast/evaluate/coil_experiments.hpp"

#include <gtest/gtest.h>

namespace limbcast::tool {
namespace {

TEST(CoilExperimentsTest, AreTheNineOfTheThesis) {
  const auto experiments = MakeCoilExperiments(1);
  ASSERT_EQ(experiments.size(), 9U);
  EXPECT_EQ(experiments.front().name, "bench");
  EXPECT_DOUBLE_EQ(experiments.front().published_magnetic_mm, 7.6);
  EXPECT_DOUBLE_EQ(experiments.back().published_fused_mm, 8.6);
}

TEST(CoilExperimentsTest, MotionsBeginAtRestAndStayInTheHalfSpaceAndInReach) {
  for (const CoilExperiment& e : MakeCoilExperiments(2)) {
    for (double t_s = 0.0; t_s < e.duration_s; t_s += 0.05) {
      const simulation::RigidMotion sensor = e.sensor(t_s);
      const simulation::RigidMotion emitter = e.emitter(t_s);
      const Eigen::Vector3d p_emitter_m =
          emitter.R_earth_local.transpose() * (sensor.p_earth_local_m - emitter.p_earth_local_m);
      EXPECT_GT(p_emitter_m.dot(e.half_space), 0.3 * p_emitter_m.norm()) << e.name << " " << t_s;
      EXPECT_GT(p_emitter_m.norm(), 0.09) << e.name;
      EXPECT_LT(p_emitter_m.norm(), 0.85) << e.name;
      if (t_s < 2.5) {
        EXPECT_LT(sensor.w_earth_local_rad_s.norm(), 0.2) << e.name;
      }
    }
  }
}

}  // namespace
}  // namespace limbcast::tool
