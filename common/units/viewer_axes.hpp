#pragma once

#include <Eigen/Geometry>
#include <cstdint>

namespace limbcast::units {

/// Whose axes a program draws in. The house axes are x forward, y left, z up, right-handed.
enum class ViewerAxes : std::uint8_t {
  kHouse,   ///< as published
  kOpenXr,  ///< OpenXR, Monado: right-handed, x right, y up, −z forward
  kUnity,   ///< Unity, VMC, VRChat: left-handed, x right, y up, z forward
  kGltf,    ///< glTF, VRM 1.0, three.js: right-handed, y up, a model faces +z, x is its left
  kIsb,     ///< ISB, OpenSim: right-handed, x forward, y up, z right
};

/// A position, velocity or axis in the viewer's axes.
///
///   OpenXR (−y, z, −x) · Unity (−y, z, x) · glTF (y, z, x) · ISB (x, z, −y)
[[nodiscard]] Eigen::Vector3d VectorIn(ViewerAxes axes, const Eigen::Vector3d& v_house);

/// An orientation with both frames re-labelled: for every v,
/// VectorIn(q·v) = RotationIn(q)·VectorIn(v). A left-handed viewer turns the other way round.
///
///   OpenXR (−y, z, −x) · Unity (y, −z, −x) · glTF (y, z, x) · ISB (x, z, −y), w unchanged
///
/// A rig whose joints do not rest in these axes needs its rest rotation beside that.
[[nodiscard]] Eigen::Quaterniond RotationIn(ViewerAxes axes, const Eigen::Quaterniond& q_house);

}  // namespace limbcast::units
