#include "common/simulation/magnetic_world.hpp"

#include <cmath>

#include "common/simulation/random.hpp"

namespace limbcast::simulation {
namespace {

constexpr double kMu0Over4Pi = 1e-7;  // T·m/A

// Moment whose field on its axis, at half a metre, is this strong: B = μ₀/4π·2m/r³.
double MomentFor_a_m2(double field_tesla) {
  constexpr double kDistance_m = 0.5;
  return field_tesla * kDistance_m * kDistance_m * kDistance_m / (2.0 * kMu0Over4Pi);
}

}  // namespace

Eigen::Vector3d EarthField_tesla(const EarthField& earth) {
  const double horizontal_tesla = earth.norm_tesla * std::cos(earth.dip_rad);
  return {horizontal_tesla * std::sin(earth.declination_rad),
          horizontal_tesla * std::cos(earth.declination_rad),
          -earth.norm_tesla * std::sin(earth.dip_rad)};
}

Eigen::Vector3d IronField_tesla(const IronZone& iron, const Eigen::Vector3d& p_earth_m) {
  const Eigen::Vector3d r_m = p_earth_m - iron.p_earth_iron_m;
  const double rho2 = r_m.squaredNorm() + iron.size_m * iron.size_m;
  const double rho3 = rho2 * std::sqrt(rho2);
  return kMu0Over4Pi *
         (3.0 * iron.moment_a_m2.dot(r_m) / (rho3 * rho2) * r_m - iron.moment_a_m2 / rho3);
}

Eigen::Vector3d MagneticWorld::At(const Eigen::Vector3d& p_earth_m) const {
  Eigen::Vector3d field_tesla = EarthField_tesla(earth);
  for (const IronZone& zone : iron) {
    field_tesla += IronField_tesla(zone, p_earth_m);
  }
  return field_tesla;
}

std::vector<IronZone> MakeIronZones(const PersonMotion& person, double duration_s,
                                    std::uint64_t seed, int count) {
  constexpr int kAttempts = 1000;  // a person that never leaves its place gets no iron
  Random random(seed, "iron");
  const auto floor_m = [&person](double t_s) -> Eigen::Vector3d {
    Eigen::Vector3d p_m = person.At(t_s).segments[0].p_earth_local_m;
    p_m.z() = 0.0;
    return p_m;
  };
  const Eigen::Vector3d home_m = floor_m(0.0);
  std::vector<IronZone> zones;
  for (int attempt = 0; attempt < kAttempts && static_cast<int>(zones.size()) < count; ++attempt) {
    const Eigen::Vector3d way_m = floor_m(random.Uniform(0.0, duration_s));
    const bool duct = zones.size() % 2 == 0;
    const double away_m = duct ? random.Uniform(0.0, 0.3) : random.Uniform(0.6, 1.0);
    const double bearing_rad = random.Uniform(-3.2, 3.2);
    IronZone zone;
    zone.size_m = duct ? 0.2 : 0.3;
    zone.p_earth_iron_m =
        way_m + Eigen::Vector3d(away_m * std::cos(bearing_rad), away_m * std::sin(bearing_rad),
                                duct ? -0.3 : random.Uniform(0.5, 1.0));
    const Eigen::Vector3d towards = random.Gaussian3().normalized();
    zone.moment_a_m2 = MomentFor_a_m2(random.Uniform(15e-6, 35e-6)) * towards;
    if ((zone.p_earth_iron_m - home_m).head<2>().norm() >= 1.5) {
      zones.push_back(zone);
    }
  }
  return zones;
}

}  // namespace limbcast::simulation
