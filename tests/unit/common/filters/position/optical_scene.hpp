#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "common/filters/position/inertial_mechanisation.hpp"
#include "common/filters/position/optical_inertial_filter.hpp"

namespace limbcast::test_support {

/// A synthetic hand with an inertial unit and a marker on it. Seeded, so that a failure repeats.
struct OpticalSceneConfig {
  double rate_hz = 200.0;  ///< a divisor of 2000
  double rest_s = 3.0;     ///< at rest at the start
  double motion_s = 20.0;  ///< then moving
  unsigned seed = 1;
  double amplitude_m = 0.15;
  double rate_rad_s = 1.5;   ///< amplitude of the angular rate about each axis
  double heading_rad = 0.7;  ///< of the sensor at rest, in the optical frame
  double tilt_rad = 0.3;
  filters::InertialErrors errors;  ///< of the readings
  Eigen::Vector3d p_sensor_marker_m = Eigen::Vector3d::Zero();
  double marker_lead_s = 0.0;  ///< a multiple of 0.5 ms
  double gyro_noise_rad_s = 0.0;
  double accel_noise_m_s2 = 0.0;
  double marker_noise_m = 0.0;
};

/// Samples and truth of it, one row for each inertial sample. Truth is known every 0.5 ms, so that
/// a marker may lead.
class OpticalScene {
 public:
  explicit OpticalScene(const OpticalSceneConfig& config);

  std::vector<sensing::MargSample> samples;
  std::vector<sensing::MarkerPosition> markers;
  std::vector<filters::NavigationState> truth;
  std::vector<Eigen::Vector3d> p_earth_marker_m;  ///< at the row's own time, no noise
  std::size_t first_moving_row = 0;

  [[nodiscard]] std::size_t rows() const { return samples.size(); }
  [[nodiscard]] std::size_t RowOf(Time at) const;
  void Hide(std::size_t from, std::size_t to);

 private:
  double rate_hz_;
};

/// Feeds a row; the step of the filter.
filters::OpticalStep FeedRow(filters::OpticalInertialFilter& filter, const OpticalScene& scene,
                             std::size_t row);

}  // namespace limbcast::test_support
