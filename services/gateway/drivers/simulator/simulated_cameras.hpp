#pragma once

#include <cstdint>
#include <vector>

#include "common/base/result.hpp"
#include "common/body/segment.hpp"
#include "common/config/config_file.hpp"
#include "common/simulation/marg_model.hpp"
#include "common/simulation/marker_model.hpp"
#include "common/simulation/person_motion.hpp"
#include "services/gateway/driver.hpp"

namespace limbcast::gateway {

/// Cameras that see markers on people: section [simulator.cameras]; keys as the fields, except
/// where said.
struct SimulatedCamerasConfig {
  /// Key `markers`: segments whose sensor carries a marker; its number is the segment's. Empty: no
  /// cameras.
  std::vector<body::Segment> markers;

  double rate_hz = 100.0;  ///< Range: [1, 1000]
  /// How far the stamps lead: the marker is where it will be so much later. Range: ±0.05.
  double lead_s = 0.0;
  /// From the sensor to its marker, sensor axes; key `lever_arm_m`, three numbers. Range: ±1.
  Eigen::Vector3d p_sensor_marker_m = {0.0, 0.0, 0.02};
  /// Keys noise_mm, gap_rate_hz, gap_s, ghost_rate, ghost_distance_m, swap_rate_hz, swap_s.
  simulation::MarkerErrors errors;
};

/// Reads [simulator.cameras]; refusals are remembered in the section's file.
[[nodiscard]] SimulatedCamerasConfig ReadSimulatedCameras(const config::Section& section,
                                                          SimulatedCamerasConfig defaults);
[[nodiscard]] Status Validate(const SimulatedCamerasConfig& config);

/// The markers of one person. Thread-compatible.
class SimulatedCameras {
 public:
  struct Marker {
    body::Segment segment = body::Segment::kPelvis;
    simulation::SensorMounting mounting;
  };
  SimulatedCameras(const SimulatedCamerasConfig& config, std::vector<Marker> markers,
                   const simulation::Random& random);

  /// Appends what the cameras saw since the last tick, up to `t_s`; `measured_at` is the tick's.
  void Next(const simulation::PersonMotion& motion, BodyId body_id, Time measured_at, double t_s,
            std::vector<sensing::MarkerPosition>& out);

 private:
  SimulatedCamerasConfig config_;
  std::vector<Marker> markers_;
  std::vector<Eigen::Vector3d> places_m_;
  simulation::MarkerModel model_;
  std::uint32_t frame_ = 0;
};

}  // namespace limbcast::gateway
