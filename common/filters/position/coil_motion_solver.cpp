#include "common/filters/position/coil_motion_solver.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/math/rotation.hpp"

namespace limbcast::filters {
namespace {

// Notation: S sensor, M emitter at the reference time; Psi = R_SM. Unknowns [p_M, theta_S, dv_M].

using Vector9 = Eigen::Matrix<double, 9, 1>;
using Matrix9 = Eigen::Matrix<double, 9, 9>;

struct Problem {
  const sensing::CoilSource& source;
  std::span<const CoilObservation> observations;
  const CoilMotionPrior& prior;
};

struct Normal {
  Matrix9 A = Matrix9::Zero();
  Vector9 g = Vector9::Zero();
  double cost = 0.0;
};

Normal Linearise(const Problem& problem, const CoilMotion& x) {
  Normal normal;
  for (const CoilObservation& o : problem.observations) {
    const double t_s = o.time_from_reference_s;
    const Eigen::Matrix3d& dM = o.R_reference_pulse_emitter;
    const sensing::FieldAndJacobian f = sensing::CoilField(
        problem.source, o.coil, o.current_a,
        dM.transpose() * (x.p_emitter_sensor_m + o.dp_emitter_m + t_s * x.dv_emitter_m_s));
    const Eigen::Vector3d B_S = x.R_sensor_emitter * (dM * f.field_tesla);
    const double w = 1.0 / o.sigma_tesla;
    Eigen::Matrix<double, 3, 9> J;
    J.leftCols<3>() = w * o.R_pulse_reference_sensor * x.R_sensor_emitter * dM *
                      f.jacobian_tesla_m * dM.transpose();
    J.middleCols<3>(3) = -w * o.R_pulse_reference_sensor * math::Skew(B_S);
    J.rightCols<3>() = t_s * J.leftCols<3>();
    const Eigen::Vector3d r = w * (o.field_tesla - o.R_pulse_reference_sensor * B_S);
    normal.A += J.transpose() * J;
    normal.g += J.transpose() * r;
    normal.cost += r.squaredNorm();
  }
  const Eigen::Vector3d turn_rad = math::LogSO3(
      math::QuaternionFromMatrix(x.R_sensor_emitter * problem.prior.R_sensor_emitter.transpose()));
  const double w_turn = 1.0 / (problem.prior.sigma_rad * problem.prior.sigma_rad);
  const double w_v = 1.0 / (problem.prior.sigma_v_m_s * problem.prior.sigma_v_m_s);
  normal.A.diagonal().segment<3>(3).array() += w_turn;
  normal.A.diagonal().tail<3>().array() += w_v;
  normal.g.segment<3>(3) -= w_turn * turn_rad;
  normal.g.tail<3>() -= w_v * x.dv_emitter_m_s;
  normal.cost += w_turn * turn_rad.squaredNorm() + w_v * x.dv_emitter_m_s.squaredNorm();
  return normal;
}

void Descend(const Problem& problem, int max_iterations, CoilMotion& x) {
  constexpr double kMaxStep = 0.3;  // of |p|
  constexpr double kDone = 1e-9;
  double damping = 1e-3;
  Normal normal = Linearise(problem, x);
  for (int i = 0; i < max_iterations && damping < 1e8; ++i) {
    Matrix9 A = normal.A;
    A.diagonal() *= 1.0 + damping;
    Vector9 step = A.ldlt().solve(normal.g);
    step /= std::max({1.0, step.head<3>().norm() / (kMaxStep * x.p_emitter_sensor_m.norm()),
                      step.segment<3>(3).norm()});
    if (!step.allFinite()) {
      break;
    }
    CoilMotion next = x;
    next.p_emitter_sensor_m += step.head<3>();
    next.R_sensor_emitter =
        (math::ExpSO3(step.segment<3>(3)) * Eigen::Quaterniond(x.R_sensor_emitter))
            .normalized()
            .toRotationMatrix();
    next.dv_emitter_m_s += step.tail<3>();
    const Normal after = Linearise(problem, next);
    if (!(after.cost < normal.cost)) {
      damping *= 10.0;
      continue;
    }
    const bool done = normal.cost - after.cost < kDone * normal.cost;
    x = next;
    normal = after;
    damping = std::max(1e-12, 0.1 * damping);
    if (done) {
      break;
    }
  }
  x.cost = normal.cost;
}

}  // namespace

CoilMotion SolveCoilMotion(const CoilPoseConfig& config, const sensing::CoilSource& source,
                           std::span<const CoilObservation> observations,
                           const HemisphereRule& hemisphere, const CoilMotionPrior& prior) {
  CoilMotion best;
  const std::optional<CoilStart> closed = CoilClosedForm(source, observations);
  if (!closed) {
    return best;
  }
  const Problem problem{source, observations, prior};
  Eigen::Vector3d p_M = closed->p_emitter_sensor_m;
  const Hemisphere side = HemisphereOf(hemisphere, p_M);
  if (side == Hemisphere::kOpposite) {
    p_M = -p_M;
  }
  best.cost = std::numeric_limits<double>::infinity();
  constexpr std::array kRadii = {1.0, 0.8, 1.25};
  constexpr double kTilt_rad = 0.6109;  // 35°
  const Eigen::Vector3d across = kTilt_rad * p_M.unitOrthogonal();
  const Eigen::Vector3d other = p_M.normalized().cross(across);
  const std::array<Eigen::Vector3d, 5> turns = {Eigen::Vector3d::Zero(), across, -across, other,
                                                -other};
  for (const Eigen::Vector3d& turn : turns) {
    for (const double radius : kRadii) {
      CoilMotion x;
      x.p_emitter_sensor_m = radius * (math::ExpSO3(turn) * p_M);
      x.R_sensor_emitter = prior.R_sensor_emitter;
      Descend(problem, config.max_iterations, x);
      if (x.cost < best.cost) {
        best = x;
      }
    }
    if (best.cost < config.accept_cost) {
      break;
    }
  }
  best.cov = Linearise(problem, best).A.ldlt().solve(Matrix9::Identity());
  best.cov.diagonal().head<3>().array() += config.floor_sigma_m * config.floor_sigma_m;
  best.cov.diagonal().segment<3>(3).array() += config.floor_sigma_rad * config.floor_sigma_rad;
  best.accepted = best.cost < config.accept_cost &&
                  HemisphereOf(hemisphere, best.p_emitter_sensor_m) == Hemisphere::kAsGiven &&
                  best.p_emitter_sensor_m.norm() < config.max_range_m &&
                  best.cov.topLeftCorner<3, 3>().trace() < config.max_sigma_m * config.max_sigma_m;
  return best;
}

}  // namespace limbcast::filters
