#include "common/simulation/magnetic_world.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace limbcast::simulation {
namespace {

TEST(MagneticWorldTest, AwayFromIronTheFieldHasItsNormDipAndNorth) {
  MagneticWorld world;
  world.earth.declination_rad = 0.1;
  const Eigen::Vector3d field_tesla = world.At({5.0, -3.0, 1.0});
  EXPECT_NEAR(field_tesla.norm(), 49e-6, 1e-15);
  EXPECT_NEAR(std::asin(-field_tesla.z() / field_tesla.norm()), 1.169, 1e-12);
  EXPECT_NEAR(std::atan2(field_tesla.x(), field_tesla.y()), 0.1, 1e-12);
}

TEST(MagneticWorldTest, FarFieldOfIronIsADipole) {
  const IronZone iron{.moment_a_m2 = {0.0, 0.0, 10.0}, .size_m = 0.1};
  // On the axis B = μ₀/4π·2m/r³, beside it half of that the other way round.
  const double axial_tesla = 1e-7 * 2.0 * 10.0 / 27.0;
  EXPECT_NEAR(IronField_tesla(iron, {0.0, 0.0, 3.0}).z(), axial_tesla, 0.01 * axial_tesla);
  EXPECT_NEAR(IronField_tesla(iron, {3.0, 0.0, 0.0}).z(), -0.5 * axial_tesla, 0.01 * axial_tesla);
  EXPECT_TRUE(IronField_tesla(iron, {0.0, 0.0, 0.0}).allFinite());
}

TEST(MagneticWorldTest, IronStandsAlongTheWayAndNotAtHome) {
  const auto person = *PersonMotion::Make(*MakePersonShape(1.75), {});
  const auto zones = MakeIronZones(person, 60.0, 4, 5);
  ASSERT_EQ(zones.size(), 5U);
  MagneticWorld world;
  world.iron = zones;
  const double undisturbed_tesla = world.earth.norm_tesla;
  EXPECT_NEAR(world.At({0.0, 0.0, 1.0}).norm(), undisturbed_tesla, 0.08 * undisturbed_tesla);
  double worst_rad = 0.0;
  for (double t_s = 0.0; t_s < 60.0; t_s += 0.05) {
    const auto pose = person.At(t_s);
    const Eigen::Vector3d at =
        world.At(pose.segments[body::Index(body::Segment::kRightLowerLeg)].p_earth_local_m);
    const double north_rad = std::atan2(at.x(), at.y());
    worst_rad = std::max(worst_rad, std::abs(north_rad));
  }
  EXPECT_GT(worst_rad, 10.0 * std::numbers::pi / 180.0);  // a compass on the leg is badly misled
}

TEST(MagneticWorldTest, SameSeedSameIronAndNoneForWhoStaysAtHome) {
  const auto person = *PersonMotion::Make(*MakePersonShape(1.75), {});
  const auto a = MakeIronZones(person, 60.0, 9);
  const auto b = MakeIronZones(person, 60.0, 9);
  const auto c = MakeIronZones(person, 60.0, 10);
  EXPECT_EQ(a[2].moment_a_m2, b[2].moment_a_m2);
  EXPECT_NE(a[2].moment_a_m2, c[2].moment_a_m2);

  const auto stays =
      *PersonMotion::Make(*MakePersonShape(1.75), {.schedule = MakeStandingSchedule()});
  EXPECT_TRUE(MakeIronZones(stays, 60.0, 9).empty());
}

}  // namespace
}  // namespace limbcast::simulation
