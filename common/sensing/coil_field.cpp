#include "common/sensing/coil_field.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/sensing/elliptic_integrals.hpp"

namespace limbcast::sensing {
namespace {

// Axis i of the loop (x, y, z = its axis) is axis (i + coil + 1) mod 3 of the emitter.
Eigen::Index EmitterAxis(Eigen::Index loop_axis, int coil) { return (loop_axis + coil + 1) % 3; }

}  // namespace

FieldAndJacobian LoopField(double radius_m, double ampere_turns, const Eigen::Vector3d& p_loop_m) {
  const double b = radius_m;
  const double z = p_loop_m.z();
  const double rho2 = p_loop_m.head<2>().squaredNorm();
  const double rho = std::sqrt(rho2);
  const double alpha2 = (b - rho) * (b - rho) + z * z;
  const double beta2 = (b + rho) * (b + rho) + z * z;
  const double beta = std::sqrt(beta2);
  const double m = std::min(4.0 * b * rho / beta2, 1.0 - 1e-15);  // k²
  const EllipticIntegrals e = EllipticIntegralsOf(m);
  const double C = kMu0_t_m_a * ampere_turns / std::numbers::pi;

  const double m_by_z = -2.0 * z * m / beta2;
  const double u = 0.25 - e.t * (1.0 - 0.5 * m);
  const double u_by_m = 0.5 * e.t - e.t_by_m * (1.0 - 0.5 * m);
  const double Q = e.K * u / (alpha2 * beta2 * beta);
  const double Q_by_z = (e.K_by_m * u + e.K * u_by_m) * m_by_z / (alpha2 * beta2 * beta) -
                        Q * z * (2.0 / alpha2 + 3.0 / beta2);
  const double G = 8.0 * C * b * b * z * Q;  // B_ρ / ρ
  const double G_by_z = 8.0 * C * b * b * (Q + z * Q_by_z);

  const double s = 4.0 * rho2 / beta2;
  const double bracket = 0.5 - 2.0 * e.t + m * e.t;
  const double W = 1.0 - 0.5 * m - m * m * e.t - s * bracket;
  const double W_by_m =
      -0.5 - 2.0 * m * e.t - m * m * e.t_by_m - s * (-2.0 * e.t_by_m + e.t + m * e.t_by_m);
  const double W_by_z = W_by_m * m_by_z + 2.0 * z * s / beta2 * bracket;
  const double scale = C * b * b / (alpha2 * beta);
  const double B_z = scale * e.K * W;
  const double B_z_by_z =
      scale * (e.K_by_m * m_by_z * W + e.K * W_by_z) - B_z * z * (2.0 / alpha2 + 1.0 / beta2);

  const double x = p_loop_m.x();
  const double y = p_loop_m.y();
  const double rho_G_by_rho = -2.0 * G - B_z_by_z;  // div B = 0
  const double cx = rho > 0.0 ? x / rho : 0.0;
  const double cy = rho > 0.0 ? y / rho : 0.0;
  FieldAndJacobian result;
  result.field_tesla = {x * G, y * G, B_z};
  Eigen::Matrix3d& J = result.jacobian_tesla_m;
  J(0, 0) = G + cx * cx * rho_G_by_rho;
  J(1, 1) = G + cy * cy * rho_G_by_rho;
  J(2, 2) = B_z_by_z;
  J(0, 1) = J(1, 0) = cx * cy * rho_G_by_rho;
  J(0, 2) = J(2, 0) = x * G_by_z;  // curl B = 0
  J(1, 2) = J(2, 1) = y * G_by_z;
  if (rho == 0.0) {
    J(0, 0) = J(1, 1) = -0.5 * B_z_by_z;
  }
  return result;
}

double CoilSource::MomentPerAmpere(int coil) const {
  return turns * moment_factor[coil] * std::numbers::pi * radius_m * radius_m;
}

FieldAndJacobian CoilField(const CoilSource& source, int coil, double current_a,
                           const Eigen::Vector3d& p_emitter_m) {
  const Eigen::Vector3d p_coil_m = p_emitter_m - source.centre_m.col(coil);
  Eigen::Vector3d p_loop_m;
  for (Eigen::Index i = 0; i < 3; ++i) {
    p_loop_m[i] = p_coil_m[EmitterAxis(i, coil)];
  }
  const FieldAndJacobian loop =
      LoopField(source.radius_m, source.turns * source.moment_factor[coil] * current_a, p_loop_m);
  FieldAndJacobian result;
  for (Eigen::Index i = 0; i < 3; ++i) {
    result.field_tesla[EmitterAxis(i, coil)] = loop.field_tesla[i];
    for (Eigen::Index j = 0; j < 3; ++j) {
      result.jacobian_tesla_m(EmitterAxis(i, coil), EmitterAxis(j, coil)) =
          loop.jacobian_tesla_m(i, j);
    }
  }
  return result;
}

FieldAndJacobian CoilsField(const CoilSource& source, const Eigen::Vector3d& currents_a,
                            const Eigen::Vector3d& p_emitter_m) {
  FieldAndJacobian sum;
  for (int coil = 0; coil < 3; ++coil) {
    if (currents_a[coil] == 0.0) {
      continue;
    }
    const FieldAndJacobian one = CoilField(source, coil, currents_a[coil], p_emitter_m);
    sum.field_tesla += one.field_tesla;
    sum.jacobian_tesla_m += one.jacobian_tesla_m;
  }
  return sum;
}

Eigen::Matrix3d CoilFieldsPerAmpere(const CoilSource& source, const Eigen::Vector3d& p_emitter_m) {
  Eigen::Matrix3d fields;
  for (int coil = 0; coil < 3; ++coil) {
    fields.col(coil) = CoilField(source, coil, 1.0, p_emitter_m).field_tesla;
  }
  return fields;
}

Eigen::Vector3d DipoleField_tesla(const Eigen::Vector3d& moment_a_m2, const Eigen::Vector3d& p_m) {
  const double R = p_m.norm();
  const Eigen::Vector3d n = p_m / R;
  return kMu0_t_m_a / (4.0 * std::numbers::pi * R * R * R) *
         (3.0 * n.dot(moment_a_m2) * n - moment_a_m2);
}

}  // namespace limbcast::sensing
