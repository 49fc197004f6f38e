#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "common/simulation/person_motion.hpp"

namespace limbcast::simulation {

/// The earth's field as a compass sees it. Defaults: central Europe.
struct EarthField {
  double norm_tesla = 49e-6;
  double dip_rad = 1.169;        ///< below the horizon, 67°
  double declination_rad = 0.0;  ///< magnetic north, clockwise from the y axis
};

/// B = |B|·(cos δ·sin D, cos δ·cos D, −sin δ) in E (x east, y north, z up), dip δ, declination D.
[[nodiscard]] Eigen::Vector3d EarthField_tesla(const EarthField& earth);

/// A piece of magnetised iron (a desk, a duct under the floor, a radiator).
struct IronZone {
  Eigen::Vector3d p_earth_iron_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment_a_m2 = Eigen::Vector3d::Zero();
  double size_m = 0.25;  ///< within about this distance the field levels off
};

/// Field of a piece of iron: that of a dipole, with ρ² = r² + size² for r² so that it stays finite
/// inside (where it is an invention; outside it is right to (size/r)²):
///   B = μ₀/4π·(3·(m·r)·r/ρ⁵ − m/ρ³)
///
/// Griffiths, "Introduction to Electrodynamics", 4th ed., Eq. (5.89).
[[nodiscard]] Eigen::Vector3d IronField_tesla(const IronZone& iron,
                                              const Eigen::Vector3d& p_earth_m);

/// Earth and iron.
struct MagneticWorld {
  EarthField earth;
  std::vector<IronZone> iron;

  [[nodiscard]] Eigen::Vector3d At(const Eigen::Vector3d& p_earth_m) const;
};

/// Iron beside, and under, the way that `person` walks in its first `duration_s`: `count` pieces,
/// alternately a duct under the floor and something of table height at 0.6 to 1 m from the way,
/// none within 1.5 m of where the person begins, each 15 to 35 µT strong at half a metre.
[[nodiscard]] std::vector<IronZone> MakeIronZones(const PersonMotion& person, double duration_s,
                                                  std::uint64_t seed, int count = 8);

}  // namespace limbcast::simulation
