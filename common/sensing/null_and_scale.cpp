#include "common/sensing/null_and_scale.hpp"

#include <algorithm>
#include <numeric>
#include <string>

#include "common/base/expects.hpp"
#include "common/sensing/axis_words.hpp"

namespace limbcast::sensing {
namespace {

struct Extremes {
  Eigen::Vector3d max;
  Eigen::Vector3d min;
};

Extremes ExtremesOf(std::span<const Eigen::Vector3d> readings) {
  Extremes found{.max = readings.front(), .min = readings.front()};
  for (const Eigen::Vector3d& reading : readings) {
    found.max = found.max.cwiseMax(reading);
    found.min = found.min.cwiseMin(reading);
  }
  return found;
}

}  // namespace

Result<NullAndScale> NullAndScaleFrom(double max, double min, double units) {
  if (!(max > min)) {
    return Error{ErrorCode::kInvalidArgument,
                 "the largest reading must be above the smallest, is " + NumberText(max, 6) +
                     " and " + NumberText(min, 6)};
  }
  return NullAndScale{.null = (max + min) / 2.0, .scale = 2.0 * units / (max - min)};
}

Result<TriadCalibration> SixPositionAccel(std::span<const Eigen::Vector3d> means,
                                          double gravity_m_s2) {
  constexpr double kNear = 0.8;
  if (means.empty()) {
    return Error{ErrorCode::kInvalidArgument, "no position at rest: hold each of the six still"};
  }
  const Extremes found = ExtremesOf(means);
  TriadCalibration triad;
  std::string missing;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      const double reached = sign > 0.0 ? found.max(axis) : -found.min(axis);
      if (reached < kNear * gravity_m_s2) {
        missing +=
            (missing.empty() ? "" : ", ") + DirectionWords(sign * Eigen::Vector3d::Unit(axis));
      }
    }
  }
  if (!missing.empty()) {
    return Error{ErrorCode::kInvalidArgument,
                 "positions missing: hold still with " + missing + " up"};
  }
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const auto line = NullAndScaleFrom(found.max(axis), found.min(axis), gravity_m_s2);
    triad.offset(axis) = line->null;
    triad.matrix(axis, axis) = line->scale;
  }
  return triad;
}

Result<TriadCalibration> MinMaxMag(std::span<const Eigen::Vector3d> readings, double field_tesla) {
  constexpr std::size_t kFewest = 6;
  if (readings.size() < kFewest) {
    return Error{ErrorCode::kInvalidArgument, "magnetometer readings must be at least 6, are " +
                                                  std::to_string(readings.size())};
  }
  const Extremes found = ExtremesOf(readings);
  const Eigen::Vector3d half = (found.max - found.min) / 2.0;
  Eigen::Index narrowest = 0;
  if (half.minCoeff(&narrowest) < 0.5 * half.maxCoeff()) {
    const std::string axis = DirectionWords(Eigen::Vector3d::Unit(narrowest)).substr(1);
    return Error{ErrorCode::kInvalidArgument, "axis " + axis +
                                                  " spans less than half of the widest: point +" +
                                                  axis + " and -" + axis + " along the field"};
  }
  const double units = field_tesla > 0.0 ? field_tesla : half.mean();
  TriadCalibration triad;
  triad.offset = (found.max + found.min) / 2.0;
  triad.matrix = (units * half.cwiseInverse()).asDiagonal();
  return triad;
}

Eigen::Vector3d GyroNull(std::span<const Eigen::Vector3d> readings_at_rest) {
  Expects(!readings_at_rest.empty(), "readings at rest");
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& reading : readings_at_rest) {
    sum += reading;
  }
  return sum / static_cast<double>(readings_at_rest.size());
}

Result<double> GyroScaleFromKnownRotation(double known_rad, std::span<const double> readings_rad_s,
                                          double null_rad_s, double dt_s) {
  constexpr double kLeast_rad = 0.1;
  const double sum = std::accumulate(readings_rad_s.begin(), readings_rad_s.end(), 0.0);
  const double estimated_rad =
      (sum - static_cast<double>(readings_rad_s.size()) * null_rad_s) * dt_s;
  if (std::abs(estimated_rad) < kLeast_rad || estimated_rad * known_rad <= 0.0) {
    return Error{ErrorCode::kInvalidArgument,
                 "the gyro saw a rotation of " + NumberText(estimated_rad, 3) + " rad, told were " +
                     NumberText(known_rad, 3) + " rad"};
  }
  return known_rad / estimated_rad;
}

}  // namespace limbcast::sensing
