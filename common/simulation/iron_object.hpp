#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/simulation/magnetic_world.hpp"
#include "common/simulation/random.hpp"

namespace limbcast::simulation {

/// Radius of a ball of iron (7870 kg/m³).
[[nodiscard]] double IronBallRadius_m(double mass_kg);

/// A compact piece of soft iron in the earth's field. The field induces the moment of a sphere of
/// high permeability, and earlier fields left a permanent one:
///   m = 3 V B / μ₀ + m_permanent
/// Outside a sphere its field is exactly that of a dipole at the centre, so size_m is 0.
///
/// Jackson, "Classical Electrodynamics", 3rd ed., section 5.11, Eq. (5.115) with μ → ∞.
///
/// @param permanent_moment_a_m2  in E.
[[nodiscard]] IronZone MakeIronBall(double mass_kg, const Eigen::Vector3d& p_earth_center_m,
                                    const Eigen::Vector3d& permanent_moment_a_m2,
                                    const EarthField& earth);

/// A box of sheet steel, such as a tool case.
struct IronCase {
  Eigen::Vector3d p_earth_center_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d size_m = Eigen::Vector3d::Constant(0.5);  ///< edges along the earth axes
  double wall_m = 0.0015;
  double relative_permeability = 200.0;
  /// Magnetisation that the sheet keeps, A/m; its direction differs from place to place.
  double remanence_a_m = 0.0;
};

/// The case as dipoles, one in the middle of each cell of at most `cell_m`; together they carry the
/// induced moment of a spherical shell of the same volume V, radius a and wall t,
///   m = 3 V B/μ₀ · s/(1 + s),  s = ⅔ μ_r t/a
/// and each the remanence of its share of the sheet in a direction of its own, drawn from `random`.
/// Each is levelled off (size_m) within half a cell, so that it holds on the surface too.
///
/// Jackson, ibid., section 5.12, thin shell.
[[nodiscard]] std::vector<IronZone> MakeIronCase(const IronCase& box, const EarthField& earth,
                                                 Random& random, double cell_m = 0.2);

}  // namespace limbcast::simulation
