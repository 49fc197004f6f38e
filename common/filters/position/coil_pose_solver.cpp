#include "common/filters/position/coil_pose_solver.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/math/rotation.hpp"

namespace limbcast::filters {
namespace {

// Notation: S sensor, M emitter at the reference time; Psi = R_SM. Unknowns [p_M, theta_S].

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Matrix36 = Eigen::Matrix<double, 3, 6>;

struct Problem {
  const CoilPoseConfig& config;
  const sensing::CoilSource& source;
  std::span<const CoilObservation> observations;
};

struct Normal {
  Matrix6 A = Matrix6::Zero();
  Vector6 g = Vector6::Zero();
  Eigen::Matrix<double, 6, 3> velocity = Eigen::Matrix<double, 6, 3>::Zero();  // Jᵀ W ∂y/∂v
  double cost = 0.0;
};

Normal Linearise(const Problem& problem, const CoilStart& pose) {
  Normal normal;
  for (const CoilObservation& o : problem.observations) {
    const Eigen::Matrix3d& dM = o.R_reference_pulse_emitter;
    const sensing::FieldAndJacobian f =
        sensing::CoilField(problem.source, o.coil, o.current_a,
                           dM.transpose() * (pose.p_emitter_sensor_m + o.dp_emitter_m));
    const Eigen::Vector3d B_S = pose.R_sensor_emitter * (dM * f.field_tesla);
    const double w = 1.0 / o.sigma_tesla;
    Matrix36 J;
    J.leftCols<3>() = w * o.R_pulse_reference_sensor * pose.R_sensor_emitter * dM *
                      f.jacobian_tesla_m * dM.transpose();
    J.rightCols<3>() = -w * o.R_pulse_reference_sensor * math::Skew(B_S);
    const Eigen::Vector3d r = w * (o.field_tesla - o.R_pulse_reference_sensor * B_S);
    normal.A += J.transpose() * J;
    normal.g += J.transpose() * r;
    normal.velocity += o.time_from_reference_s * J.transpose() * J.leftCols<3>();
    normal.cost += r.squaredNorm();
  }
  return normal;
}

double CostOf(const Problem& problem, const CoilStart& pose) {
  double cost = 0.0;
  for (const CoilObservation& o : problem.observations) {
    cost += ((o.field_tesla - PredictCoilField_tesla(problem.source, o, pose)) / o.sigma_tesla)
                .squaredNorm();
  }
  return cost;
}

CoilStart Moved(const CoilStart& pose, const Vector6& step) {
  return {pose.p_emitter_sensor_m + step.head<3>(),
          (math::ExpSO3(step.tail<3>()) * Eigen::Quaterniond(pose.R_sensor_emitter))
              .normalized()
              .toRotationMatrix()};
}

// Levenberg–Marquardt from `pose`; returns the cost reached.
double Descend(const Problem& problem, CoilStart& pose) {
  constexpr double kMaxStep = 0.3;  // of |p|
  constexpr double kMaxTurn_rad = 1.0;
  constexpr double kDone = 1e-9;  // relative change of cost
  double damping = 1e-3;
  Normal normal = Linearise(problem, pose);
  for (int i = 0; i < problem.config.max_iterations; ++i) {
    Matrix6 A = normal.A;
    A.diagonal() *= 1.0 + damping;
    Vector6 step = A.ldlt().solve(normal.g);
    const double limit =
        std::max({1.0, step.head<3>().norm() / (kMaxStep * pose.p_emitter_sensor_m.norm()),
                  step.tail<3>().norm() / kMaxTurn_rad});
    step /= limit;
    if (!step.allFinite()) {
      break;
    }
    const CoilStart next = Moved(pose, step);
    const double cost = CostOf(problem, next);
    if (!(cost < normal.cost)) {
      damping *= 10.0;
      if (damping > 1e8) {
        break;
      }
      continue;
    }
    const bool done = normal.cost - cost < kDone * normal.cost;
    pose = next;
    damping = std::max(1e-12, 0.1 * damping);
    normal = Linearise(problem, pose);
    if (done) {
      break;
    }
  }
  return normal.cost;
}

// The start turned and scaled: radius factors × directions.
double DescendFromMany(const Problem& problem, const CoilStart& first, double good_cost,
                       CoilStart& best, double best_cost, int& starts) {
  constexpr std::array kRadii = {1.0, 0.8, 1.25, 0.65, 1.5};
  constexpr double kTilt_rad = 0.6109;  // 35°
  const std::optional<Eigen::Matrix3d> S = SignalMatrix(problem.observations);
  if (!S) {
    return best_cost;
  }
  const Eigen::Vector3d across = first.p_emitter_sensor_m.unitOrthogonal();
  const Eigen::Vector3d other = first.p_emitter_sensor_m.normalized().cross(across);
  const std::array<Eigen::Vector3d, 5> turns = {Eigen::Vector3d::Zero(), kTilt_rad * across,
                                                -kTilt_rad * across, kTilt_rad * other,
                                                -kTilt_rad * other};
  for (const Eigen::Vector3d& turn : turns) {
    for (const double radius : kRadii) {
      CoilStart pose;
      pose.p_emitter_sensor_m = radius * (math::ExpSO3(turn) * first.p_emitter_sensor_m);
      pose.R_sensor_emitter = ProcrustesRotation(
          *S, sensing::CoilFieldsPerAmpere(problem.source, pose.p_emitter_sensor_m));
      const double cost = Descend(problem, pose);
      ++starts;
      if (cost < best_cost) {
        best_cost = cost;
        best = pose;
      }
      if (best_cost < good_cost) {
        return best_cost;
      }
    }
  }
  return best_cost;
}

// Coils apart have different fields at p and −p, and say themselves where the sensor is; now and
// then something between fits about as well. Descends from all eight octants, leaves the best in
// `pose` that `rule` allows, and says whether no other fits.
Hemisphere BestOfAllOctants(const Problem& problem, const HemisphereRule& rule, CoilStart& pose,
                            double& cost) {
  constexpr double kTold = 25.0;      // of cost apart: five sigma
  constexpr double kElsewhere = 0.2;  // of |p|: another minimum
  const std::optional<Eigen::Matrix3d> S = SignalMatrix(problem.observations);
  if (!S) {
    return Hemisphere::kUndecided;
  }
  std::array<CoilStart, 9> found;
  std::array<double, 9> costs{};
  found[8] = pose;
  costs[8] = cost;
  for (std::size_t octant = 0; octant < 8; ++octant) {
    const Eigen::Vector3d signs((octant & 1U) != 0 ? -1.0 : 1.0, (octant & 2U) != 0 ? -1.0 : 1.0,
                                (octant & 4U) != 0 ? -1.0 : 1.0);
    CoilStart& start = found[octant];
    start.p_emitter_sensor_m = signs.cwiseProduct(pose.p_emitter_sensor_m);
    start.R_sensor_emitter = ProcrustesRotation(
        *S, sensing::CoilFieldsPerAmpere(problem.source, start.p_emitter_sensor_m));
    costs[octant] = Descend(problem, start);
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (HemisphereOf(rule, found[i].p_emitter_sensor_m) == Hemisphere::kOpposite) {
      costs[i] = std::numeric_limits<double>::infinity();
    }
  }
  const auto best = static_cast<std::size_t>(std::ranges::min_element(costs) - costs.begin());
  if (std::isinf(costs[best])) {
    return Hemisphere::kUndecided;
  }
  pose = found[best];
  cost = costs[best];
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double apart_m = (found[i].p_emitter_sensor_m - pose.p_emitter_sensor_m).norm();
    if (apart_m > kElsewhere * pose.p_emitter_sensor_m.norm() && !(costs[i] > cost + kTold)) {
      return Hemisphere::kUndecided;
    }
  }
  return Hemisphere::kAsGiven;
}

void SetCovariance(const Problem& problem, const CoilStart& pose, CoilPose& result) {
  const Normal normal = Linearise(problem, pose);
  result.cost = normal.cost;
  result.cov_noise = normal.A.ldlt().solve(Matrix6::Identity());
  result.by_velocity = -result.cov_noise * normal.velocity;
  const Eigen::Matrix<double, 6, 3>& J_v = result.by_velocity;
  result.cov = result.cov_noise + problem.config.var_velocity_m2_s2 * J_v * J_v.transpose();
  const double floor_p = problem.config.floor_sigma_m;
  const double floor_r = problem.config.floor_sigma_rad;
  result.cov.diagonal().head<3>().array() += floor_p * floor_p;
  result.cov.diagonal().tail<3>().array() += floor_r * floor_r;
}

}  // namespace

Eigen::Vector3d PredictCoilField_tesla(const sensing::CoilSource& source, const CoilObservation& o,
                                       const CoilStart& pose) {
  const Eigen::Matrix3d& dM = o.R_reference_pulse_emitter;
  return o.R_pulse_reference_sensor * pose.R_sensor_emitter * dM *
         sensing::CoilField(source, o.coil, o.current_a,
                            dM.transpose() * (pose.p_emitter_sensor_m + o.dp_emitter_m))
             .field_tesla;
}

CoilPose SolveCoilPose(const CoilPoseConfig& config, const sensing::CoilSource& source,
                       std::span<const CoilObservation> observations,
                       const HemisphereRule& hemisphere,
                       const std::optional<CoilStart>& predicted) {
  CoilPose result;
  const Problem problem{config, source, observations};
  std::optional<CoilStart> closed = CoilClosedForm(source, observations);
  if (!closed) {
    return result;
  }
  // The displacements between the pulses are not mirrored: begin on the side of the sensor.
  if (HemisphereOf(hemisphere, closed->p_emitter_sensor_m) == Hemisphere::kOpposite) {
    closed->p_emitter_sensor_m = -closed->p_emitter_sensor_m;
  }
  // Degrees of freedom above the usual nine let the cost grow by as much.
  const double good_cost =
      config.accept_cost + 3.0 * std::max(0.0, static_cast<double>(observations.size()) - 3.0);
  CoilStart pose = predicted ? *predicted : *closed;
  result.starts = 1;
  double cost = Descend(problem, pose);
  if (predicted && !(cost < good_cost)) {
    CoilStart again = *closed;
    const double cost_again = Descend(problem, again);
    ++result.starts;
    if (cost_again < cost) {
      cost = cost_again;
      pose = again;
    }
  }
  if (!(cost < good_cost)) {
    cost = DescendFromMany(problem, *closed, good_cost, pose, cost, result.starts);
  }
  const Hemisphere side = source.concentric() ? HemisphereOf(hemisphere, pose.p_emitter_sensor_m)
                                              : BestOfAllOctants(problem, hemisphere, pose, cost);
  if (side == Hemisphere::kOpposite) {
    pose.p_emitter_sensor_m = -pose.p_emitter_sensor_m;
    cost = Descend(problem, pose);
  }
  result.p_emitter_sensor_m = pose.p_emitter_sensor_m;
  result.q_sensor_emitter = math::QuaternionFromMatrix(pose.R_sensor_emitter);
  SetCovariance(problem, pose, result);
  const double var_p = result.cov.topLeftCorner<3, 3>().trace();
  result.verdict = !(cost < good_cost)                                   ? CoilPoseVerdict::kPoorFit
                   : pose.p_emitter_sensor_m.norm() > config.max_range_m ? CoilPoseVerdict::kTooFar
                   : !(var_p <= config.max_sigma_m * config.max_sigma_m)
                       ? CoilPoseVerdict::kTooUncertain
                   : side == Hemisphere::kUndecided ? CoilPoseVerdict::kUndecided
                                                    : CoilPoseVerdict::kAccepted;
  return result;
}

}  // namespace limbcast::filters
