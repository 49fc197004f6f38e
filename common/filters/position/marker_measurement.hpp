#pragma once

#include <Eigen/Core>

#include "common/filters/position/optical_inertial_states.hpp"

namespace limbcast::filters {

/// What one optical marker should measure, and how that depends on the state.
struct MarkerPrediction {
  Eigen::Vector3d p_earth_marker_m;
  Eigen::Vector3d v_earth_marker_m_s;
  Eigen::Matrix<double, optical::kMarkerAxes, optical::kStates> H;
};

/// The measurement model of one marker (design/position.md section 4), with t = t_d + t_stamp:
///
///   h = p + R r + t (v + R (w × r)) + t²/2 a
///   H: p: I ; v: t I ; θ: −[R r + t R (w × r)]× ; b_g: t R [r]× ; r: R (I + t [w]×) ;
///      t_d: v + R (w × r) + t a
///
/// The t² term and the small terms of H are not in the specification; 4 ms at 40 m/s² is 0.3 mm.
///
/// @param w_rad_s              angular rate, corrected, sensor frame.
/// @param accel_in_earth_m_s2  acceleration of the sensor, gravity removed; taken as known.
/// @param stamp_after_state_s  how much later the marker's stamp is than the state; within a few
/// ms.
[[nodiscard]] MarkerPrediction PredictMarker(const OpticalInertialState& state,
                                             const Eigen::Vector3d& w_rad_s,
                                             const Eigen::Vector3d& accel_in_earth_m_s2,
                                             double stamp_after_state_s);

/// Variance of one axis: s_o² + (s_tau |v_marker|)².
[[nodiscard]] inline double MarkerVariance(double sigma_m, double sigma_time_s,
                                           const Eigen::Vector3d& v_earth_marker_m_s) {
  return sigma_m * sigma_m + sigma_time_s * sigma_time_s * v_earth_marker_m_s.squaredNorm();
}

}  // namespace limbcast::filters
