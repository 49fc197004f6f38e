#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace limbcast::body {

/// A horizontal line that movement singles out; which way along it is not known.
struct HorizontalAxis {
  double direction_rad = 0.0;  ///< counter-clockwise from x, in (−π/2, π/2]
  double sigma_rad = 0.0;
};

/// The line along which horizontal parts of `vectors` scatter most: the way a limb swings (of
/// accelerations), or across it (of angular rates).
///
/// The uncertainty is kAxisFloor_rad (soft tissue, limbs that do not swing quite straight) and
/// grows with the ratio of the two variances, as the minor one is no noise but other movement.
[[nodiscard]] HorizontalAxis PrincipalAxis(const std::vector<Eigen::Vector3d>& vectors);

/// The line along which horizontal parts of `vectors` repeat with every step and not only with
/// every stride: with e, o = ½(v(t) ± v(t + half a stride)) the eigenvector of Cov(e) − Cov(o) of
/// the greatest eigenvalue. The trunk of a person who walks is pushed forward alike by both legs,
/// but sideways to the left by one and to the right by the other.
///
/// Menz, Lord, Fitzpatrick, "Acceleration patterns of the head and pelvis when walking on level and
/// irregular surfaces", Gait & Posture 18 (2003) 35–46 (even harmonics forward and up, odd ones
/// sideways); the eigenvalue problem is ours.
[[nodiscard]] HorizontalAxis SymmetricAxis(const std::vector<Eigen::Vector3d>& vectors,
                                           std::size_t half_stride);

/// How much, from −1 to 1, `direction_rad` is forward for a segment of the trunk: correlation of
/// the velocity's fluctuation along it with the vertical acceleration, both of the part that
/// repeats with every step. A walking body is an inverted pendulum: it is slowest over the standing
/// leg, where it is highest, and there its vertical acceleration is least.
///
/// Cavagna, Heglund, Taylor, "Mechanical work in terrestrial locomotion", Am. J. Physiol. 233
/// (1977) R243–R261 (potential and kinetic energy out of phase).
[[nodiscard]] double PendulumForwardness(const std::vector<Eigen::Vector3d>& accel_m_s2,
                                         double direction_rad, std::size_t half_stride,
                                         double rate_hz);

}  // namespace limbcast::body
