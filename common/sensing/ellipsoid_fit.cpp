#include "common/sensing/ellipsoid_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <optional>
#include <string>

#include "common/sensing/axis_words.hpp"
#include "common/sensing/sphere_coverage.hpp"

// Readings are scaled to a mean length of about one inside; r readings, M symmetric, b offset.
namespace limbcast::sensing {
namespace {

using Matrix9 = Eigen::Matrix<double, 9, 9>;
using Vector9 = Eigen::Matrix<double, 9, 1>;

struct Shape {
  Eigen::Matrix3d M = Eigen::Matrix3d::Identity();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
};

struct Spread {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d narrow = Eigen::Vector3d::UnitZ();  // direction of the least extent
  double length = 1.0;                                // RMS distance from the mean
};

Spread SpreadOf(std::span<const Eigen::Vector3d> readings) {
  Spread spread;
  for (const Eigen::Vector3d& r : readings) {
    spread.mean += r / static_cast<double>(readings.size());
  }
  Eigen::Matrix3d cov = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& r : readings) {
    cov += (r - spread.mean) * (r - spread.mean).transpose() / static_cast<double>(readings.size());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(cov);
  spread.narrow = axes.eigenvectors().col(0);
  spread.length = std::sqrt(std::max(cov.trace(), 1e-300));
  return spread;
}

// rᵀAr + 2vᵀr = 1 by linear least squares, in readings moved to their mean and scaled by their
// spread; nothing when it is no ellipsoid.
std::optional<Shape> AlgebraicFit(std::span<const Eigen::Vector3d> readings, const Spread& spread) {
  Matrix9 normal = Matrix9::Zero();
  Vector9 right = Vector9::Zero();
  for (const Eigen::Vector3d& reading : readings) {
    const Eigen::Vector3d r = (reading - spread.mean) / spread.length;
    Vector9 row;
    row << r.x() * r.x(), r.y() * r.y(), r.z() * r.z(), 2.0 * r.x() * r.y(), 2.0 * r.x() * r.z(),
        2.0 * r.y() * r.z(), 2.0 * r.x(), 2.0 * r.y(), 2.0 * r.z();
    normal += row * row.transpose();
    right += row;
  }
  const Vector9 p = normal.ldlt().solve(right);
  Eigen::Matrix3d A;
  A << p(0), p(3), p(4), p(3), p(1), p(5), p(4), p(5), p(2);
  const Eigen::FullPivLU<Eigen::Matrix3d> lu(A);
  if (!p.allFinite() || !lu.isInvertible()) {
    return std::nullopt;
  }
  const Eigen::Vector3d centre = -lu.solve(p.tail<3>());
  const double k = 1.0 + centre.dot(A * centre);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(A / k);
  constexpr double kFlattest = 1e-2;  // ratio of squared half axes: 1 : 10 in length
  if (!(axes.eigenvalues().minCoeff() > kFlattest * axes.eigenvalues().maxCoeff())) {
    return std::nullopt;
  }
  return Shape{.M = axes.operatorSqrt() / spread.length, .b = spread.mean + spread.length * centre};
}

// One Gauss–Newton step; residuals beyond `limit` are weighted down (Huber). `information` becomes
// JᵀJ by (length·M, b/length). Returns the RMS of the weighted residuals before the step.
double Step(std::span<const Eigen::Vector3d> readings, double limit, Shape& shape,
            Matrix9& information, double length) {
  information.setZero();
  Vector9 right = Vector9::Zero();
  double sum = 0.0;
  for (const Eigen::Vector3d& reading : readings) {
    const Eigen::Vector3d d = reading - shape.b;
    const Eigen::Vector3d y = shape.M * d;
    const double norm = y.norm();
    const Eigen::Vector3d u = y / norm;
    const Eigen::Vector3d e = d / length;
    const Eigen::Vector3d by_b = -(shape.M * u) * length;
    Vector9 row;
    row << u.x() * e.x(), u.y() * e.y(), u.z() * e.z(), u.x() * e.y() + u.y() * e.x(),
        u.x() * e.z() + u.z() * e.x(), u.y() * e.z() + u.z() * e.y(), by_b;
    const double residual = norm - 1.0;
    const double weight = std::abs(residual) > limit ? limit / std::abs(residual) : 1.0;
    information += weight * row * row.transpose();
    right -= weight * residual * row;
    sum += weight * residual * residual;
  }
  const Vector9 step = information.ldlt().solve(right);
  Eigen::Matrix3d dM;
  dM << step(0), step(3), step(4), step(3), step(1), step(5), step(4), step(5), step(2);
  shape.M += dM / length;
  shape.b += step.tail<3>() * length;
  return std::sqrt(sum / static_cast<double>(readings.size()));
}

Error TooNarrow(const Spread& spread, std::string_view words) {
  const std::string axis = DirectionWords(spread.narrow);
  const std::string other = DirectionWords(-spread.narrow);
  return {ErrorCode::kInvalidArgument,
          "the readings lie too near to one plane or arc for a fit: "
          "turn the sensor until " +
              axis + " and " + other + " have been" + std::string(words)};
}

SphereCoverage CoverageOf(std::span<const Eigen::Vector3d> readings,
                          const TriadCalibration& calibration) {
  SphereCoverage coverage;
  for (const Eigen::Vector3d& r : readings) {
    coverage.Add(calibration.Apply(r));
  }
  return coverage;
}

}  // namespace

double LengthResidual(std::span<const Eigen::Vector3d> readings,
                      const TriadCalibration& calibration, double norm) {
  const auto count = static_cast<double>(readings.size());
  if (!(norm > 0.0)) {
    for (const Eigen::Vector3d& r : readings) {
      norm += calibration.Apply(r).norm() / count;
    }
  }
  double sum = 0.0;
  for (const Eigen::Vector3d& r : readings) {
    const double residual = calibration.Apply(r).norm() / norm - 1.0;
    sum += residual * residual;
  }
  return readings.empty() ? 0.0 : std::sqrt(sum / count);
}

Result<TriadFit> FitEllipsoid(std::span<const Eigen::Vector3d> readings,
                              const EllipsoidConfig& config, std::string_view words_of_position) {
  constexpr std::size_t kFewest = 12;  // nine unknowns and something to judge them by
  if (readings.size() < kFewest) {
    return Error{ErrorCode::kInvalidArgument,
                 "different positions must be at least 12, are " + std::to_string(readings.size())};
  }
  const Spread spread = SpreadOf(readings);
  std::optional<Shape> shape = AlgebraicFit(readings, spread);
  if (!shape) {
    return TooNarrow(spread, words_of_position);
  }
  constexpr int kSteps = 12;
  Matrix9 information;
  double rms = 1e9;  // of the weighted residuals
  for (int i = 0; i < kSteps; ++i) {
    rms = Step(readings, config.huber_sigmas * rms, *shape, information, spread.length);
    if (!shape->M.allFinite() || shape->M.determinant() <= 0.0) {
      return TooNarrow(spread, words_of_position);
    }
  }
  const double size = config.norm > 0.0 ? config.norm : 1.0 / std::cbrt(shape->M.determinant());
  TriadFit fit;
  fit.calibration = {.matrix = size * shape->M, .offset = shape->b};
  fit.method = "ellipsoid";
  fit.points = readings.size();
  fit.residual_before = LengthResidual(readings, {}, config.norm);
  fit.residual_after = LengthResidual(readings, fit.calibration, size);
  const auto count = static_cast<double>(readings.size());
  const double variance = rms * rms * count / (count - 9.0);
  const Vector9 sigma = (variance * information.inverse().diagonal()).cwiseSqrt();
  // Elements of M are in units of 1/length inside, and the diagonal is near 1/(length of a
  // reading).
  const double by_matrix = size / spread.length;
  fit.sigma_scale = by_matrix * sigma.head<6>().maxCoeff();
  fit.sigma_offset = spread.length / size * sigma.tail<3>().maxCoeff();
  if (!(fit.sigma_scale <= 10.0 * config.max_sigma)) {
    return TooNarrow(spread, words_of_position);
  }
  const SphereCoverage coverage = CoverageOf(readings, fit.calibration);
  fit.coverage = coverage.share();
  if (fit.coverage < config.min_coverage) {
    return Error{ErrorCode::kInvalidArgument,
                 "only " + PercentText(fit.coverage) + " of the directions are covered, " +
                     PercentText(config.min_coverage) + " are needed: missing " +
                     coverage.MissingWords() + std::string(words_of_position)};
  }
  if (fit.residual_after > config.max_residual) {
    return Error{ErrorCode::kInvalidArgument,
                 "the corrected length still varies by " + PercentText(fit.residual_after, 1) +
                     " RMS, at most " + PercentText(config.max_residual, 1) +
                     " is allowed: the sensor was shaken, or iron or a magnet was near"};
  }
  if (fit.sigma_scale > config.max_sigma) {
    return Error{ErrorCode::kInvalidArgument,
                 "the scale would be uncertain by " + PercentText(fit.sigma_scale, 2) +
                     ", at most " + PercentText(config.max_sigma, 2) +
                     " is allowed: more positions are needed, first of all " +
                     DirectionWords(spread.narrow) + std::string(words_of_position)};
  }
  return fit;
}

}  // namespace limbcast::sensing
