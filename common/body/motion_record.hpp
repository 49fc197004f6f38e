#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "common/body/segment.hpp"

namespace limbcast::body {

/// What one sensor did, at an even rate. `E` is the sensor's own earth frame: z is up, and its
/// heading is whatever its filter started with.
struct SegmentRecord {
  Segment segment = Segment::kPelvis;
  std::vector<Eigen::Quaterniond> q_earth_sensor;
  std::vector<Eigen::Vector3d> accel_in_earth_m_s2;  ///< gravity removed
};

/// The sensors of one person over one stretch of time; all of the same length, sample for sample at
/// the same instants.
struct MotionRecord {
  double rate_hz = 50.0;
  std::vector<SegmentRecord> segments;  ///< pelvis first if it has one, parents before children

  [[nodiscard]] std::size_t size() const {
    return segments.empty() ? 0 : segments.front().q_earth_sensor.size();
  }
};

/// A record made smooth, with the derivatives that the fits need.
struct SmoothMotion {
  Segment segment = Segment::kPelvis;
  std::vector<Eigen::Quaterniond> q_earth_sensor;
  std::vector<Eigen::Vector3d> accel_in_earth_m_s2;
  std::vector<Eigen::Vector3d> w_earth_sensor_in_earth_rad_s;
  std::vector<Eigen::Vector3d> alpha_in_earth_rad_s2;
};

/// Angular rate by central differences of the orientation (a sensor with a filter on board need not
/// give its gyroscope), then everything through the same Hann window of `width_s`, whose half power
/// is at 0.72/width_s: 0.12 s leaves what a limb does below 6 Hz and takes away the shock of the
/// heel. The first and last width_s are copies of their neighbours.
[[nodiscard]] std::vector<SmoothMotion> Smooth(const MotionRecord& record, double width_s);

/// Leaves what is in [begin, end).
void Cut(std::size_t begin, std::size_t end, std::vector<SmoothMotion>& motions);

/// Takes a heading that changes with time out of everything: v(t) becomes Rz(−heading(t))·v(t).
void TurnBack(const std::vector<double>& heading_rad, std::vector<SmoothMotion>& motions);

/// Heading that an orientation has gained since `reference`, unwrapped over the whole stretch.
[[nodiscard]] std::vector<double> HeadingSince_rad(
    const Eigen::Quaterniond& reference, const std::vector<Eigen::Quaterniond>& q_earth_sensor);

/// Mean over `width` values around each; fewer at the ends.
[[nodiscard]] std::vector<double> MovingMean(const std::vector<double>& values, std::size_t width);

}  // namespace limbcast::body
