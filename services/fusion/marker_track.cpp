#include "services/fusion/marker_track.hpp"

namespace limbcast::fusion {

std::optional<SegmentPosition> MarkerTrack::Update(
    const sensing::MargSample& sample, const std::optional<Eigen::Quaterniond>& q_earth_sensor) {
  if (!filter_.started() && !q_earth_sensor) {
    return std::nullopt;
  }
  const filters::OpticalStep step = filter_.AddInertial(sample, q_earth_sensor);
  if (!filter_.started() || !IsUsed(step.verdict)) {
    return std::nullopt;
  }
  const filters::NavigationState& now = filter_.state().navigation;
  SegmentPosition position;
  position.p_earth_sensor_m = now.p_earth_sensor_m;
  position.v_earth_sensor_m_s = now.v_earth_sensor_m_s;
  position.cov_position_m2 = filter_.epoch().P.topLeftCorner<3, 3>();
  position.fill = step.epoch_closed && filter_.epoch().had_marker ? FillKind::kMeasured
                                                                  : FillKind::kInertialForward;
  const double var_m2 = position.cov_position_m2.trace();
  if (!(var_m2 < kLeastCertain_m * kLeastCertain_m)) {
    return std::nullopt;
  }
  return position;
}

}  // namespace limbcast::fusion
