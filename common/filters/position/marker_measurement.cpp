#include "common/filters/position/marker_measurement.hpp"

#include "common/math/rotation.hpp"

namespace limbcast::filters {

MarkerPrediction PredictMarker(const OpticalInertialState& state, const Eigen::Vector3d& w_rad_s,
                               const Eigen::Vector3d& accel_in_earth_m_s2,
                               double stamp_after_state_s) {
  using namespace optical;
  const double t_s = state.marker_lead_s + stamp_after_state_s;
  const Eigen::Matrix3d R_ES = state.navigation.q_earth_sensor.toRotationMatrix();
  const Eigen::Vector3d& r_S = state.p_sensor_marker_m;
  const Eigen::Vector3d lever_E = R_ES * r_S;
  const Eigen::Vector3d swing_E = R_ES * w_rad_s.cross(r_S);

  MarkerPrediction out;
  out.v_earth_marker_m_s = state.navigation.v_earth_sensor_m_s + swing_E;
  out.p_earth_marker_m = state.navigation.p_earth_sensor_m + lever_E +
                         t_s * out.v_earth_marker_m_s + 0.5 * t_s * t_s * accel_in_earth_m_s2;
  out.H.setZero();
  out.H.middleCols<3>(kP).setIdentity();
  out.H.middleCols<3>(kV) = t_s * Eigen::Matrix3d::Identity();
  out.H.middleCols<3>(kTheta) = -math::Skew(lever_E + t_s * swing_E);
  out.H.middleCols<3>(kGyroBias) = t_s * R_ES * math::Skew(r_S);
  out.H.middleCols<3>(kLever) = R_ES * (Eigen::Matrix3d::Identity() + t_s * math::Skew(w_rad_s));
  out.H.col(kTimeOffset) = out.v_earth_marker_m_s + t_s * accel_in_earth_m_s2;
  return out;
}

}  // namespace limbcast::filters
