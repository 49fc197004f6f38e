#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>

#include "common/base/time.hpp"
#include "common/filters/position/inertial_gate.hpp"
#include "common/filters/position/marker_gate.hpp"

namespace limbcast::filters {

/// A start of the inertial + optical filter.
struct OpticalStartResult {
  NavigationState navigation;  ///< now, of the marker's point: r is taken as zero
  Eigen::Vector3d gyro_bias_rad_s = Eigen::Vector3d::Zero();
  double heading_rad = 0.0;  ///< of the optical frame in the levelled one
  bool had_rest = false;     ///< levelled and gyro bias measured at rest
  // For those who can go back to the rest (offline): when it was and the state in it.
  Time rest_begun_at{};
  Time rest_ended_at{};
  Eigen::Quaterniond q_earth_sensor_at_rest = Eigen::Quaterniond::Identity();
};

/// Attitude of an inertial unit in the frame of an optical system that sees one marker of it
/// (design/position.md section 4, initialisation).
///
/// At rest: roll and pitch from the mean specific force, gyro bias from the mean rate. In motion:
/// the gyro is integrated in a levelled frame of arbitrary heading, acceleration twice to s(t), and
/// over windows of 2.5 s, a new one every 1.25 s, least squares solves
///
///   z_x = c s_x − d s_y + p0_x + v0_x t + a0_x t²/2 ,   z_y = d s_x + c s_y + p0_y + ... ,
///   ψ = atan2(d, c) ,   accepted when |hypot(c, d) − 1| < 0.1 and 3 σ(c) < 0.06
///
/// Sums only, no buffers: allocates nothing. Without any rest in the first seconds the frame is
/// levelled with the mean force over 2 s and the gyro bias taken as zero. Thread-compatible.
class OpticalStart {
 public:
  explicit OpticalStart(double gravity_m_s2);

  /// Takes the next reading; `marker` when one belongs to its time (within half a step).
  /// @returns a start once there is one.
  [[nodiscard]] std::optional<OpticalStartResult> Add(Time at, const GatedInertial& inertial,
                                                      const std::optional<TimedMarker>& marker);

  /// Time in motion without an accepted window.
  [[nodiscard]] double searched_s() const { return searched_s_; }
  /// The best guess without an accepted window, for a search over headings: levelled, heading of
  /// the levelled frame. Nothing before levelling or before a marker.
  [[nodiscard]] std::optional<OpticalStartResult> Guess(double heading_rad) const;

 private:
  // Unknowns of one window: c, d, then p0, v0, a0 for x and y; z apart with p0, v0, a0.
  struct Window {
    Time begun_at{};
    bool open = false;
    int n = 0;
    double dt_s = 0.0;  // length so far
    Eigen::Vector3d s = Eigen::Vector3d::Zero();
    Eigen::Vector3d ds = Eigen::Vector3d::Zero();
    Eigen::Vector3d z_first = Eigen::Vector3d::Zero();
    Eigen::Matrix<double, 8, 8> A = Eigen::Matrix<double, 8, 8>::Zero();
    Eigen::Matrix<double, 8, 1> b = Eigen::Matrix<double, 8, 1>::Zero();
    double zz = 0.0;
    Eigen::Matrix3d A_z = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b_z = Eigen::Vector3d::Zero();
  };

  void Level(const Eigen::Vector3d& mean_force_S, const Eigen::Vector3d& mean_rate_S, bool at_rest,
             Time begun_at);
  void CollectRest(Time at, const GatedInertial& inertial);
  void AddToWindow(Window& window, const Eigen::Vector3d& accel_L, double dt_s,
                   const std::optional<TimedMarker>& marker);
  [[nodiscard]] std::optional<OpticalStartResult> Solve(const Window& window) const;
  [[nodiscard]] OpticalStartResult Turned(double heading_rad) const;

  double gravity_m_s2_;
  bool levelled_ = false;
  bool had_rest_ = false;
  Eigen::Quaterniond q_LS_ = Eigen::Quaterniond::Identity();  // levelled frame L from sensor
  Eigen::Quaterniond q_LS_rest_ = Eigen::Quaterniond::Identity();
  Time rest_begun_at_{};
  Time rest_ended_at_{};
  Eigen::Vector3d gyro_bias_rad_s_ = Eigen::Vector3d::Zero();
  InertialReading last_;
  double since_start_s_ = 0.0;
  double searched_s_ = 0.0;
  std::optional<TimedMarker> last_marker_;

  // the rest block that is being filled, and the rest before it
  Time block_begun_at_{};
  double block_s_ = 0.0;
  int block_n_ = 0;
  Eigen::Vector3d block_gyro_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d block_gyro2_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d block_force_ = Eigen::Vector3d::Zero();
  int rest_n_ = 0;
  Eigen::Vector3d rest_gyro_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d rest_force_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d unrest_force_L_ = Eigen::Vector3d::Zero();  // for levelling in motion
  double unrest_s_ = 0.0;

  std::array<Window, 2> windows_{};
  double to_next_window_s_ = 0.0;
  std::size_t next_window_ = 0;
};

}  // namespace limbcast::filters
