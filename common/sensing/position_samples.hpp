#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "common/base/ids.hpp"
#include "common/base/time.hpp"

namespace limbcast::sensing {

/// One optical marker as the camera system places it.
struct MarkerPosition {
  BodyId body_id;
  std::uint32_t marker = 0;
  std::uint32_t sequence = 0;
  Time measured_at{};
  Time published_at{};
  Eigen::Vector3d p_earth_marker_m = Eigen::Vector3d::Zero();
  float sigma_m = 0.0F;
  bool visible = false;  ///< false: p_earth_marker_m means nothing, the marker is hidden
};

/// An absolute position of a body's root from outside (radio, GNSS, ...).
struct PositionFix {
  BodyId body_id;
  std::uint32_t sequence = 0;
  Time measured_at{};
  Time published_at{};
  Eigen::Vector3d p_earth_body_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d cov_m2 = Eigen::Matrix3d::Zero();  ///< symmetric
};

}  // namespace limbcast::sensing
