#include "common/units/viewer_axes.hpp"

namespace limbcast::units {

Eigen::Vector3d VectorIn(ViewerAxes axes, const Eigen::Vector3d& v) {
  switch (axes) {
    case ViewerAxes::kHouse:
      break;
    case ViewerAxes::kOpenXr:
      return {-v.y(), v.z(), -v.x()};
    case ViewerAxes::kUnity:
      return {-v.y(), v.z(), v.x()};
    case ViewerAxes::kGltf:
      return {v.y(), v.z(), v.x()};
    case ViewerAxes::kIsb:
      return {v.x(), v.z(), -v.y()};
  }
  return v;
}

Eigen::Quaterniond RotationIn(ViewerAxes axes, const Eigen::Quaterniond& q) {
  // An axis of rotation is a pseudovector: a map that mirrors turns it round.
  const double sign = axes == ViewerAxes::kUnity ? -1.0 : 1.0;
  const Eigen::Vector3d axis = sign * VectorIn(axes, q.vec());
  return {q.w(), axis.x(), axis.y(), axis.z()};
}

}  // namespace limbcast::units
