#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "common/base/time.hpp"
#include "common/filters/position/inertial_mechanisation.hpp"
#include "common/filters/position/marker_gate.hpp"

namespace limbcast::filters {

/// Start of the inertial + optical filter of a unit whose attitude somebody else knows (an
/// orientation filter), in motion as well as at rest: only position and velocity are to be found.
/// Acceleration is integrated twice to s(t), and least squares over the markers of a short window
/// solve, axis by axis,
///
///   z_i − s(t_i) − R_i r = p0 + v0 t_i
///
/// Accepted when what is left is small; else (a ghost, a swapped marker) a new window begins. Sums
/// only: allocates nothing. Thread-compatible.
class KnownAttitudeStart {
 public:
  static constexpr double kWindow_s = 0.25;
  static constexpr int kFewestMarkers = 6;
  static constexpr double kMostLeft_m = 0.02;  ///< RMS of one axis
  static constexpr double kLongestStep_s = 0.1;

  /// @param p_sensor_marker_m  r, as far as it is known.
  KnownAttitudeStart(double gravity_m_s2, const Eigen::Vector3d& p_sensor_marker_m)
      : gravity_m_s2_(gravity_m_s2), p_sensor_marker_m_(p_sensor_marker_m) {}

  /// Takes the next reading, `dt_s` after the last; `marker` when one belongs to its time (within
  /// half a step). @returns where the unit is, and how fast, once that is known.
  [[nodiscard]] std::optional<NavigationState> Add(const InertialReading& reading, double dt_s,
                                                   const Eigen::Quaterniond& q_earth_sensor,
                                                   const std::optional<TimedMarker>& marker);

  void Clear();

 private:
  double gravity_m_s2_;
  Eigen::Vector3d p_sensor_marker_m_;
  bool begun_ = false;
  double t_s_ = 0.0;
  Eigen::Vector3d accel_E_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d s_m_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d ds_m_s_ = Eigen::Vector3d::Zero();
  int n_ = 0;
  double sum_t_ = 0.0;
  double sum_tt_ = 0.0;
  Eigen::Vector3d first_m_ = Eigen::Vector3d::Zero();  // taken off, so that sums stay small
  Eigen::Vector3d sum_y_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d sum_ty_ = Eigen::Vector3d::Zero();
  double sum_yy_ = 0.0;
};

}  // namespace limbcast::filters
