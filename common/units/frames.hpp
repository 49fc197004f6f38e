#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string_view>

#include "common/base/result.hpp"

namespace limbcast::units {

/// Changes of axes at the border: earth frames of other people, and boards whose sensors are
/// mounted along other axes than they are read. Inside the project earth is ENU (x east, y north,
/// z up). Thread-safe.

/// The rotation from NED (x north, y east, z down) to ENU coordinates: (0, √½, √½, 0), its own
/// inverse up to the sign.
[[nodiscard]] Eigen::Quaterniond QuaternionEnuNed();

/// A vector of one earth frame in coordinates of the other: (x, y, z) → (y, x, −z) both ways.
[[nodiscard]] Eigen::Vector3d EnuFromNed(const Eigen::Vector3d& v_ned);
[[nodiscard]] Eigen::Vector3d NedFromEnu(const Eigen::Vector3d& v_enu);

/// An orientation given in one earth frame, in the other; the body frame stays what it is.
[[nodiscard]] Eigen::Quaterniond EnuFromNed(const Eigen::Quaterniond& q_ned_any);
[[nodiscard]] Eigen::Quaterniond NedFromEnu(const Eigen::Quaterniond& q_enu_any);

/// Adds the magnetic declination (east positive): y then points to true north.
[[nodiscard]] Eigen::Quaterniond TrueFromMagneticNorth(const Eigen::Quaterniond& q_magnetic_any,
                                                       double declination_rad);

/// From the viewer frame (y up, −z forward, x right; OpenXR) to ENU with forward = north, and back.
[[nodiscard]] Eigen::Vector3d EnuFromViewer(const Eigen::Vector3d& v_viewer);
[[nodiscard]] Eigen::Vector3d ViewerFromEnu(const Eigen::Vector3d& v_enu);

/// A signed permutation of axes: which axis of a reading, with which sign, becomes x, y and z.
/// Right-handed maps only: a left-handed one would mirror every rotation.
class AxisMap {
 public:
  /// Nothing moves.
  AxisMap() = default;

  /// From three letters with optional signs, as configuration gives it: "+x+y+z", "y-xz". Fails
  /// with kInvalidArgument on anything else, a repeated axis or a left-handed map.
  [[nodiscard]] static Result<AxisMap> Parse(std::string_view text);

  [[nodiscard]] Eigen::Vector3d Apply(const Eigen::Vector3d& v) const;
  [[nodiscard]] Eigen::Vector3f Apply(const Eigen::Vector3f& v) const;
  /// The map as a rotation matrix: Apply(v) = matrix()·v.
  [[nodiscard]] Eigen::Matrix3d matrix() const;

 private:
  std::array<int, 3> source_{0, 1, 2};
  std::array<int, 3> sign_{1, 1, 1};
};

}  // namespace limbcast::units
