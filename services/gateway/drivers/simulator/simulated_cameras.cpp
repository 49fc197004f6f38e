#include "services/gateway/drivers/simulator/simulated_cameras.hpp"

#include <string>
#include <utility>

#include "common/config/named_values.hpp"

namespace limbcast::gateway {
namespace {

constexpr double kMetresPerMillimetre = 1e-3;

}  // namespace

SimulatedCamerasConfig ReadSimulatedCameras(const config::Section& section,
                                            SimulatedCamerasConfig config) {
  config.markers = config::ReadNamedList(section, "markers", config.markers, body::ParseSegment,
                                         "segments like pelvis");
  config.rate_hz = section.Read("rate_hz", config.rate_hz, 1.0, 1000.0);
  config.lead_s = section.Read("lead_s", config.lead_s, -0.05, 0.05);
  const Eigen::Vector3d& r = config.p_sensor_marker_m;
  const auto lever = section.ReadNumbers("lever_arm_m", {r.x(), r.y(), r.z()}, -1.0, 1.0, 3);
  if (lever.size() == 3) {
    config.p_sensor_marker_m = {lever[0], lever[1], lever[2]};
  }
  simulation::MarkerErrors& errors = config.errors;
  errors.sigma_m = kMetresPerMillimetre *
                   section.Read("noise_mm", errors.sigma_m / kMetresPerMillimetre, 0.0, 100.0);
  errors.gap_rate_hz = section.Read("gap_rate_hz", errors.gap_rate_hz, 0.0, 100.0);
  errors.gap_s = section.Read("gap_s", errors.gap_s, 0.0, 100.0);
  errors.ghost_rate = section.Read("ghost_rate", errors.ghost_rate, 0.0, 1.0);
  errors.ghost_distance_m = section.Read("ghost_distance_m", errors.ghost_distance_m, 1e-6, 10.0);
  errors.swap_rate_hz = section.Read("swap_rate_hz", errors.swap_rate_hz, 0.0, 100.0);
  errors.swap_s = section.Read("swap_s", errors.swap_s, 0.0, 100.0);
  return config;
}

Status Validate(const SimulatedCamerasConfig& config) {
  if (!(config.rate_hz >= 1.0 && config.rate_hz <= 1000.0)) {
    return Error{
        ErrorCode::kInvalidArgument,
        "simulator.cameras.rate_hz must be in [1, 1000], is " + std::to_string(config.rate_hz)};
  }
  if (!(config.lead_s >= -0.05 && config.lead_s <= 0.05)) {
    return Error{
        ErrorCode::kInvalidArgument,
        "simulator.cameras.lead_s must be in [-0.05, 0.05], is " + std::to_string(config.lead_s)};
  }
  if (const Status errors = simulation::Validate(config.errors); !errors) {
    return Error{errors.error().code, "simulator.cameras: " + errors.error().message};
  }
  return Ok();
}

SimulatedCameras::SimulatedCameras(const SimulatedCamerasConfig& config,
                                   std::vector<Marker> markers, const simulation::Random& random)
    : config_(config),
      markers_(std::move(markers)),
      places_m_(markers_.size()),
      model_(config.errors, markers_.size(), random) {}

void SimulatedCameras::Next(const simulation::PersonMotion& motion, BodyId body_id,
                            Time measured_at, double t_s,
                            std::vector<sensing::MarkerPosition>& out) {
  constexpr double kRounding_s = 1e-9;
  while (!markers_.empty() && frame_ / config_.rate_hz <= t_s + kRounding_s) {
    const double at_s = frame_ / config_.rate_hz;
    const simulation::PersonPose pose = motion.At(at_s + config_.lead_s);
    for (std::size_t i = 0; i < markers_.size(); ++i) {
      const simulation::RigidMotion& segment = pose.segments[body::Index(markers_[i].segment)];
      const simulation::SensorMounting& mounting = markers_[i].mounting;
      places_m_[i] =
          segment.p_earth_local_m +
          segment.R_earth_local *
              (mounting.p_segment_sensor_m + mounting.q_segment_sensor * config_.p_sensor_marker_m);
    }
    ++frame_;
    const auto seen = model_.See(places_m_, 1.0 / config_.rate_hz);
    for (std::size_t i = 0; i < markers_.size(); ++i) {
      sensing::MarkerPosition marker;
      marker.body_id = body_id;
      marker.marker = static_cast<std::uint32_t>(body::Index(markers_[i].segment));
      marker.sequence = frame_;
      marker.measured_at = measured_at - DurationFromSeconds(t_s - at_s);
      marker.p_earth_marker_m = seen[i].p_earth_marker_m;
      marker.sigma_m = static_cast<float>(config_.errors.sigma_m);
      marker.visible = seen[i].visible;
      out.push_back(marker);
    }
  }
}

}  // namespace limbcast::gateway
