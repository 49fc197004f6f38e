#include "common/filters/position/optical_outputs.hpp"

#include "common/filters/position/marker_measurement.hpp"
#include "common/math/rotation.hpp"

namespace limbcast::filters {

using namespace optical;

PositionEstimate ForwardEstimate(const OpticalEpoch& epoch) {
  const MarkerPrediction marker = PredictMarker(epoch.state, epoch.w_earth_sensor_in_sensor_rad_s,
                                                epoch.accel_in_earth_m_s2, 0.0);
  PositionEstimate out;
  out.at = epoch.at;
  out.fill = epoch.had_marker ? FillKind::kMeasured : FillKind::kInertialForward;
  out.degraded = epoch.degraded;
  out.p_earth_sensor_m = epoch.state.navigation.p_earth_sensor_m;
  out.v_earth_sensor_m_s = epoch.state.navigation.v_earth_sensor_m_s;
  out.accel_in_earth_m_s2 = epoch.accel_in_earth_m_s2;
  out.q_earth_sensor = epoch.state.navigation.q_earth_sensor;
  out.p_earth_marker_m = marker.p_earth_marker_m;
  out.cov_position_m2 = marker.H * epoch.P * marker.H.transpose();
  return out;
}

OutputRows OutputRowsOf(const OpticalEpoch& epoch) {
  OutputRows rows;
  const MarkerPrediction marker = PredictMarker(epoch.state, epoch.w_earth_sensor_in_sensor_rad_s,
                                                epoch.accel_in_earth_m_s2, 0.0);
  rows.middleRows<3>(kOutMarker).noalias() = marker.H * epoch.P;
  rows.middleRows<9>(kOutP) = epoch.P.topRows<9>();
  rows.middleRows<3>(kOutAccel).noalias() = epoch.accel_rows * epoch.P;
  return rows;
}

void Correct(const OutputVector& d, PositionEstimate& estimate) {
  estimate.p_earth_marker_m += d.segment<3>(kOutMarker);
  estimate.p_earth_sensor_m += d.segment<3>(kOutP);
  estimate.v_earth_sensor_m_s += d.segment<3>(kOutV);
  estimate.q_earth_sensor =
      (math::ExpSO3(d.segment<3>(kOutTheta)) * estimate.q_earth_sensor).normalized();
  estimate.accel_in_earth_m_s2 += d.segment<3>(kOutAccel);
}

}  // namespace limbcast::filters
