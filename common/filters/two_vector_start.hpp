#pragma once

#include <Eigen/Geometry>
#include <optional>

namespace limbcast::filters {

/// Orientation from the specific force and the field alone (design/orientation.md section 2): rows
/// east, north, up of R from u = a/|a|, e = m × u, n = u × e. Exact, so there is no wrong start.
///
/// @param accel_m_s2  mean specific force, sensor axes.
/// @param mag         mean field, sensor axes, any unit.
/// @returns nothing when |a| < 1e-6 or m is parallel to a within 1e-6.
[[nodiscard]] std::optional<Eigen::Quaterniond> OrientationFromTwoVectors(
    const Eigen::Vector3d& accel_m_s2, const Eigen::Vector3d& mag);

/// Without a field: the shortest rotation that turns the specific force upright; heading 0.
[[nodiscard]] std::optional<Eigen::Quaterniond> OrientationFromUpright(
    const Eigen::Vector3d& accel_m_s2);

/// The reference field of a start: (0, √(m₁²+m₂²), m₃) of a field in ENU, same unit.
[[nodiscard]] Eigen::Vector3d ReferenceField(const Eigen::Vector3d& mag_in_earth);

/// What TwoVectorStart remembers; copied as bytes when a filter saves its state.
struct TwoVectorStartState {
  Eigen::Quaterniond q_first_sensor = Eigen::Quaterniond::Identity();  // since the window's begin
  Eigen::Vector3d sum_accel_m_s2 = Eigen::Vector3d::Zero();            // in the first sample's axes
  Eigen::Vector3d sum_mag_tesla = Eigen::Vector3d::Zero();
  double time_s = 0.0;
  double accel_count = 0.0;
  double mag_count = 0.0;
};

/// Averages both vectors over the start window while the gyro takes the rotation out of them, so
/// that a sensor may be moved while it starts. Thread-compatible.
class TwoVectorStart {
 public:
  /// A start from the samples so far.
  struct Start {
    Eigen::Quaterniond q_earth_sensor = Eigen::Quaterniond::Identity();
    Eigen::Vector3d mag_in_earth_tesla = Eigen::Vector3d::Zero();  ///< zero without magnetometer
    bool has_field = false;
  };

  /// Takes one sample; null for a vector that is not usable.
  void Add(const Eigen::Vector3d& gyro_rad_s, double dt_s, const Eigen::Vector3d* accel_m_s2,
           const Eigen::Vector3d* mag_tesla);

  /// The window is as long as asked for. A start can still fail, then it goes on.
  [[nodiscard]] bool complete(double window_s) const { return state_.time_s >= window_s; }
  [[nodiscard]] std::optional<Start> Solve() const;
  void Clear() { state_ = {}; }

  [[nodiscard]] const TwoVectorStartState& state() const { return state_; }
  [[nodiscard]] TwoVectorStartState& mutable_state() { return state_; }

 private:
  TwoVectorStartState state_;
};

}  // namespace limbcast::filters
