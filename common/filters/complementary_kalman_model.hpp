#pragma once

#include <Eigen/Geometry>

namespace limbcast::filters {

/// The linear model of the complementary Kalman filter (Roetenberg ch. 2–3, corrected as
/// design/orientation.md sections 4 and 8 say). Error vector, estimate − truth: θ 0–2 in the sensor
/// frame with R̂ = R(I + [θ×]), b 3–5, d 6–8.

using Matrix9 = Eigen::Matrix<double, 9, 9>;
using Matrix69 = Eigen::Matrix<double, 6, 9>;
using Vector9 = Eigen::Matrix<double, 9, 1>;

/// C of z = C x [R·2.32 corrected]: rows gravity and field on the a-priori errors,
/// [ −[Z×] 0 0 ; −[(H + d)×] 0 −I ].
[[nodiscard]] Matrix69 ComplementaryMeasurementMatrix(const Eigen::Vector3d& Z_S,
                                                      const Eigen::Vector3d& H_S,
                                                      const Eigen::Vector3d& d_S);

/// F of the a-priori errors of the corrected, full structure: F_θθ = Φ, F_θb = −T I, F_bb = I,
/// F_dd = c_d Φ with Φ = R(Exp(ωT))ᵀ.
[[nodiscard]] Matrix9 ComplementaryTransition(const Eigen::Vector3d& w_S_rad_s, double dt_s,
                                              double c_d);

/// P⁻ = F P⁺ Fᵀ, multiplied out by blocks; the noise is still to be added.
[[nodiscard]] Matrix9 PropagateFull(const Matrix9& P, const Eigen::Vector3d& w_S_rad_s, double dt_s,
                                    double c_d);

/// The published block structure [R·2.19, 2.34 corrected]: cross covariances of the last update and
/// the turn of the error axes are dropped.
[[nodiscard]] Matrix9 PropagateBlocks(const Matrix9& P, double dt_s, double c_d);

}  // namespace limbcast::filters
