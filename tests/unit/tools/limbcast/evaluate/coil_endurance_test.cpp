#include "tools/limbcast/evaluate/coil_endurance.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "common/simulation/coil_stream.hpp"

namespace limbcast::tool {
namespace {

TEST(CoilEnduranceTest, SubjectsStayAboveTheirSourceAndDiffer) {
  double sum_m = 0.0;
  double last_m = 0.0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const CoilSubject subject = MakeCoilSubject(seed);
    for (double t_s = 0.0; t_s < 100.0; t_s += 0.7) {
      const simulation::RigidMotion sensor = subject.stream.sensor(t_s);
      const simulation::RigidMotion emitter = subject.stream.emitter(t_s);
      const Eigen::Vector3d p_m =
          emitter.R_earth_local.transpose() * (sensor.p_earth_local_m - emitter.p_earth_local_m);
      EXPECT_GT(p_m.z(), 0.08) << seed << " at " << t_s;
      EXPECT_LT(p_m.norm(), 0.65);
      sum_m += std::abs(p_m.norm() - last_m);
      last_m = p_m.norm();
    }
  }
  EXPECT_GT(sum_m, 1.0);
}

TEST(CoilEnduranceTest, TheSameSeedGivesTheSameFigures) {
  const CoilEndurance a = RunCoilSubject(3, 12.0, 5.0);
  const CoilEndurance b = RunCoilSubject(3, 12.0, 5.0);
  EXPECT_EQ(a.rms_m, b.rms_m);
  EXPECT_EQ(a.injected, b.injected);
  EXPECT_EQ(a.injected, 1);
  EXPECT_GT(a.rms_m, 0.0);
}

TEST(CoilEnduranceTest, SumsKeepCountsAndMeanSquares) {
  CoilEndurance a{.hours = 1.0, .runs = 1, .injected = 2, .slowest_s = 0.5, .rms_m = 0.01};
  const CoilEndurance b{.hours = 3.0, .runs = 2, .late = 1, .slowest_s = 0.7, .rms_m = 0.02};
  const CoilEndurance sum = a + b;
  EXPECT_EQ(sum.runs, 3);
  EXPECT_EQ(sum.injected, 2);
  EXPECT_EQ(sum.late, 1);
  EXPECT_EQ(sum.slowest_s, 0.7);
  EXPECT_NEAR(sum.rms_m, std::sqrt((1e-4 + 3.0 * 4e-4) / 4.0), 1e-12);
}

}  // namespace
}  // namespace limbcast::tool
