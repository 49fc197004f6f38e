#include "common/sensing/gyro_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "common/math/rotation.hpp"
#include "common/sensing/axis_words.hpp"

// Notation: S sensor axes; R turns coordinates at the end of a stretch into those at its begin, so
// that u_end = Rᵀ u_begin. M by columns: m = (M00, M10, M20, M01, …).
namespace limbcast::sensing {
namespace {

using Matrix3x9 = Eigen::Matrix<double, 3, 9>;
using Matrix9 = Eigen::Matrix<double, 9, 9>;
using Vector9 = Eigen::Matrix<double, 9, 1>;

struct Carried {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Matrix3x9 dphi = Matrix3x9::Zero();                  // turn of the end, in its axes, by m
  Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();  // raw, both ways added
};

Carried Carry(std::span<const MargSample> samples, const CarriedDirection& span,
              const Eigen::Matrix3d& M) {
  Carried carried;
  const double length_s =
      std::max(ToSeconds(samples[span.end].measured_at - samples[span.begin].measured_at), 1e-9);
  for (std::size_t i = span.begin; i < span.end; ++i) {
    const double dt_s = ToSeconds(samples[i + 1].measured_at - samples[i].measured_at);
    const double part =
        (ToSeconds(samples[i].measured_at - samples[span.begin].measured_at) + dt_s / 2.0) /
        length_s;
    const Eigen::Vector3d null =
        (1.0 - part) * span.null_before_rad_s + part * span.null_after_rad_s;
    const Eigen::Vector3d raw =
        (samples[i].gyro_rad_s + samples[i + 1].gyro_rad_s).cast<double>() / 2.0 - null;
    const Eigen::Matrix3d step = math::ExpSO3(M * raw * dt_s).toRotationMatrix();
    carried.R *= step;
    carried.dphi = step.transpose() * carried.dphi;
    for (Eigen::Index column = 0; column < 3; ++column) {
      carried.dphi.block<3, 3>(0, 3 * column) += raw(column) * dt_s * Eigen::Matrix3d::Identity();
    }
    carried.turn_rad += raw.cwiseAbs() * dt_s;
  }
  return carried;
}

double Residual(std::span<const MargSample> samples, std::span<const CarriedDirection> carried,
                const Eigen::Matrix3d& M) {
  double sum = 0.0;
  for (const CarriedDirection& span : carried) {
    sum += (span.after - CarryDirection(samples, span, M)).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(carried.size()));
}

Status CheckTurns(const Eigen::Vector3d& turned_rad, double needed_rad) {
  std::string missing;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (turned_rad(axis) < needed_rad) {
      missing += (missing.empty() ? "" : ", ") +
                 DirectionWords(Eigen::Vector3d::Unit(axis)).substr(1) + " (" +
                 NumberText(turned_rad(axis) * 57.29578, 0) + " of " +
                 NumberText(needed_rad * 57.29578, 0) + " deg)";
    }
  }
  return missing.empty()
             ? Ok()
             : Status(Error{ErrorCode::kInvalidArgument, "turn more about axis " + missing});
}

}  // namespace

Eigen::Vector3d CarryDirection(std::span<const MargSample> samples, const CarriedDirection& carried,
                               const Eigen::Matrix3d& matrix) {
  return Carry(samples, carried, matrix).R.transpose() * carried.before;
}

Result<TriadFit> FitGyro(std::span<const MargSample> samples,
                         std::span<const CarriedDirection> carried, const GyroFitConfig& config) {
  constexpr std::size_t kFewest = 6;  // two equations each, nine unknowns
  if (carried.size() < kFewest) {
    return Error{ErrorCode::kInvalidArgument,
                 "turns from one pose at rest to another must be at least 6, are " +
                     std::to_string(carried.size())};
  }
  Eigen::Matrix3d M = Eigen::Matrix3d::Identity();
  Matrix9 information;
  Eigen::Vector3d turned_rad;
  constexpr int kSteps = 6;
  for (int step = 0; step < kSteps; ++step) {
    information.setZero();
    turned_rad.setZero();
    Vector9 right = Vector9::Zero();
    for (const CarriedDirection& span : carried) {
      const Carried along = Carry(samples, span, M);
      const Eigen::Vector3d u = along.R.transpose() * span.before;
      const Matrix3x9 J = math::Skew(u) * along.dphi;  // Exp(−δ)u = u + u × δ
      information += J.transpose() * J;
      right += J.transpose() * (span.after - u);
      turned_rad += along.turn_rad;
    }
    if (Status enough = CheckTurns(turned_rad, config.min_turn_rad); step == 0 && !enough) {
      return enough.error();
    }
    const Vector9 delta = information.ldlt().solve(right);
    if (!delta.allFinite()) {
      return Error{ErrorCode::kInvalidArgument,
                   "the turns do not tell the axes apart: turn about "
                   "each of x, y and z, each in two poses"};
    }
    M += Eigen::Map<const Eigen::Matrix3d>(delta.data());
  }
  TriadFit fit;
  fit.calibration.matrix = M;
  Eigen::Vector3d null = Eigen::Vector3d::Zero();
  for (const CarriedDirection& span : carried) {
    null += (span.null_before_rad_s + span.null_after_rad_s) /
            (2.0 * static_cast<double>(carried.size()));
  }
  fit.calibration.offset = null;
  fit.method = "carried-direction";
  fit.points = 2 * carried.size();
  fit.residual_before = Residual(samples, carried, Eigen::Matrix3d::Identity());
  fit.residual_after = Residual(samples, carried, M);
  const double excess = std::max(2.0 * static_cast<double>(carried.size()) - 9.0, 1.0);
  const double variance =
      fit.residual_after * fit.residual_after * static_cast<double>(carried.size()) / excess;
  fit.sigma_scale = std::sqrt(variance * information.inverse().diagonal().maxCoeff());
  fit.coverage = std::min(1.0, turned_rad.minCoeff() / (4.0 * config.min_turn_rad));
  if (!(fit.sigma_scale <= config.max_sigma) || !M.allFinite()) {
    return Error{ErrorCode::kInvalidArgument,
                 "the gyro's scale would be uncertain by " + PercentText(fit.sigma_scale, 2) +
                     ", at most " + PercentText(config.max_sigma, 2) +
                     " is allowed: turn about each of x, y and z again, from rest to rest"};
  }
  if (fit.residual_after > config.max_residual_rad) {
    return Error{ErrorCode::kInvalidArgument,
                 "gyro and accelerometer still disagree by " +
                     NumberText(fit.residual_after * 57.29578, 1) +
                     " deg after each turn: readings are missing or clipped"};
  }
  return fit;
}

}  // namespace limbcast::sensing
