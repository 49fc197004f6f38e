#include "common/simulation/iron_object.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace limbcast::simulation {
namespace {

constexpr double kIronDensity_kg_m3 = 7870.0;
constexpr double kMu0 = 4e-7 * std::numbers::pi;  // T·m/A

double BallRadius_m(double volume_m3) { return std::cbrt(0.75 * volume_m3 / std::numbers::pi); }

Eigen::Vector3d InducedMoment_a_m2(double volume_m3, const EarthField& earth) {
  return 3.0 * volume_m3 / kMu0 * EarthField_tesla(earth);
}

}  // namespace

double IronBallRadius_m(double mass_kg) { return BallRadius_m(mass_kg / kIronDensity_kg_m3); }

IronZone MakeIronBall(double mass_kg, const Eigen::Vector3d& p_earth_center_m,
                      const Eigen::Vector3d& permanent_moment_a_m2, const EarthField& earth) {
  return {.p_earth_iron_m = p_earth_center_m,
          .moment_a_m2 =
              InducedMoment_a_m2(mass_kg / kIronDensity_kg_m3, earth) + permanent_moment_a_m2,
          .size_m = 0.0};
}

std::vector<IronZone> MakeIronCase(const IronCase& box, const EarthField& earth, Random& random,
                                   double cell_m) {
  const double volume_m3 = box.size_m.prod();
  const double s = 2.0 / 3.0 * box.relative_permeability * box.wall_m / BallRadius_m(volume_m3);
  const Eigen::Vector3d& d = box.size_m;
  const double sheet_m3 = 2.0 * box.wall_m * (d.x() * d.y() + d.y() * d.z() + d.z() * d.x());
  const Eigen::Array3i cells =
      (d / cell_m - Eigen::Vector3d::Constant(1e-9)).array().ceil().cast<int>();
  const double share = 1.0 / cells.prod();
  const Eigen::Vector3d induced_a_m2 = share * s / (1.0 + s) * InducedMoment_a_m2(volume_m3, earth);
  const Eigen::Vector3d edge_m = d.array() / cells.cast<double>();
  std::vector<IronZone> zones;
  for (int x = 0; x < cells.x(); ++x) {
    for (int y = 0; y < cells.y(); ++y) {
      for (int z = 0; z < cells.z(); ++z) {
        const Eigen::Vector3d corner_m =
            edge_m.cwiseProduct(Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5));
        const Eigen::Vector3d direction = random.Gaussian3().normalized();
        zones.push_back(
            {.p_earth_iron_m = box.p_earth_center_m - 0.5 * d + corner_m,
             .moment_a_m2 = induced_a_m2 + share * sheet_m3 * box.remanence_a_m * direction,
             .size_m = 0.5 * edge_m.maxCoeff()});
      }
    }
  }
  return zones;
}

}  // namespace limbcast::simulation
