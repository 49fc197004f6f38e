#include "common/units/frames.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

#include "common/math/rotation.hpp"

namespace limbcast::units {
namespace {

constexpr double kSqrtHalf = 0.5 * std::numbers::sqrt2;

Error BadMap(std::string_view text, const char* why) {
  return Error{ErrorCode::kInvalidArgument,
               "axis map '" + std::string(text) + "' " + why + ", expected e.g. \"+y-x+z\""};
}

}  // namespace

Eigen::Quaterniond QuaternionEnuNed() { return {0.0, kSqrtHalf, kSqrtHalf, 0.0}; }

Eigen::Vector3d EnuFromNed(const Eigen::Vector3d& v_ned) {
  return {v_ned.y(), v_ned.x(), -v_ned.z()};
}
Eigen::Vector3d NedFromEnu(const Eigen::Vector3d& v_enu) { return EnuFromNed(v_enu); }

Eigen::Quaterniond EnuFromNed(const Eigen::Quaterniond& q_ned_any) {
  return QuaternionEnuNed() * q_ned_any;
}
Eigen::Quaterniond NedFromEnu(const Eigen::Quaterniond& q_enu_any) {
  return QuaternionEnuNed().conjugate() * q_enu_any;
}

Eigen::Quaterniond TrueFromMagneticNorth(const Eigen::Quaterniond& q_magnetic_any,
                                         double declination_rad) {
  return math::ExpSO3({0.0, 0.0, -declination_rad}) * q_magnetic_any;
}

Eigen::Vector3d EnuFromViewer(const Eigen::Vector3d& v_viewer) {
  return {v_viewer.x(), -v_viewer.z(), v_viewer.y()};
}
Eigen::Vector3d ViewerFromEnu(const Eigen::Vector3d& v_enu) {
  return {v_enu.x(), v_enu.z(), -v_enu.y()};
}

Result<AxisMap> AxisMap::Parse(std::string_view text) {
  AxisMap map;
  std::size_t at = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    map.sign_[axis] = 1;
    if (at < text.size() && (text[at] == '+' || text[at] == '-')) {
      map.sign_[axis] = text[at] == '-' ? -1 : 1;
      ++at;
    }
    if (at >= text.size() || text[at] < 'x' || text[at] > 'z') {
      return BadMap(text, "is not three axes out of x, y, z");
    }
    map.source_[axis] = text[at] - 'x';
    ++at;
  }
  if (at != text.size()) {
    return BadMap(text, "has something after the third axis");
  }
  const double det = map.matrix().determinant();
  if (std::abs(det) < 0.5) {
    return BadMap(text, "names an axis twice");
  }
  if (det < 0.0) {
    return BadMap(text, "is left-handed");
  }
  return map;
}

Eigen::Vector3d AxisMap::Apply(const Eigen::Vector3d& v) const {
  return {sign_[0] * v[source_[0]], sign_[1] * v[source_[1]], sign_[2] * v[source_[2]]};
}

Eigen::Vector3f AxisMap::Apply(const Eigen::Vector3f& v) const {
  return {static_cast<float>(sign_[0]) * v[source_[0]],
          static_cast<float>(sign_[1]) * v[source_[1]],
          static_cast<float>(sign_[2]) * v[source_[2]]};
}

Eigen::Matrix3d AxisMap::matrix() const {
  Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
  for (std::size_t row = 0; row < 3; ++row) {
    M(static_cast<Eigen::Index>(row), source_[row]) = sign_[row];
  }
  return M;
}

}  // namespace limbcast::units
