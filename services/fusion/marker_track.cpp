#include "services/fusion/marker_track.hpp"

#include <utility>

namespace limbcast::fusion {
namespace {

bool IsCertain(const Eigen::Matrix3d& cov_m2) {
  return cov_m2.trace() < MarkerTrack::kLeastCertain_m * MarkerTrack::kLeastCertain_m;
}

filters::OpticalInertialConfig WithLag(filters::OpticalInertialConfig config, double lag_s) {
  config.lag_s = lag_s;
  return config;
}

}  // namespace

MarkerTrack::MarkerTrack(const filters::OpticalInertialConfig& config, double lag_s)
    : filter_(config) {
  if (lag_s > 0.0) {
    lag_.emplace(WithLag(config, lag_s));
  }
}

// The covariance is that of the marker, which the sensor is centimetres away from.
std::optional<LaggedPosition> MarkerTrack::Lagged() {
  if (!std::exchange(pending_, false)) {
    return std::nullopt;
  }
  lag_->Push(filter_.epoch());
  if (!lag_->has_estimate() || !IsCertain(lag_->estimate().cov_position_m2)) {
    return std::nullopt;
  }
  const filters::PositionEstimate& estimate = lag_->estimate();
  return LaggedPosition{.measured_at = estimate.at,
                        .q_earth_sensor = estimate.q_earth_sensor,
                        .position = {.p_earth_sensor_m = estimate.p_earth_sensor_m,
                                     .v_earth_sensor_m_s = estimate.v_earth_sensor_m_s,
                                     .cov_position_m2 = estimate.cov_position_m2,
                                     .fill = estimate.fill}};
}

std::optional<SegmentPosition> MarkerTrack::Update(
    const sensing::MargSample& sample, const std::optional<Eigen::Quaterniond>& q_earth_sensor) {
  if (!filter_.started() && !q_earth_sensor) {
    return std::nullopt;
  }
  const filters::OpticalStep step = filter_.AddInertial(sample, q_earth_sensor);
  pending_ = lag_ && step.epoch_closed && filter_.started();
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
  return IsCertain(position.cov_position_m2) ? std::optional(position) : std::nullopt;
}

}  // namespace limbcast::fusion
