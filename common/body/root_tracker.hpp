#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/base/time.hpp"
#include "common/body/contact_points.hpp"
#include "common/body/forward_kinematics.hpp"
#include "common/body/ground_contact.hpp"

namespace limbcast::body {

struct RootTrackerConfig {
  GroundContactConfig contact;

  /// What a fix from outside says is made good no faster than this, so that nobody jumps. Range:
  /// (0, 10].
  double correction_m_s = 0.5;

  /// ... but one that is farther off than this is believed at once: the person was carried, or has
  /// just come into view. > 0.
  double relocate_beyond_m = 2.0;

  /// Standard deviation that walking adds to the position, as a fraction of the way. Against it the
  /// covariance of a fix is weighed. Range: (0, 1].
  double drift_of_way = 0.03;
};

/// What the sensor of a segment says beside its orientation.
struct SegmentMotion {
  bool usable = false;      ///< measured, and how it sits on the segment is known
  float rate_rad_s = 0.0F;  ///< zero where it is not known
  float accel_m_s2 = 0.0F;  ///< gravity removed; as rate_rad_s
};

/// Where a person is, from what its segments do: the points on the ground stay where they are, and
/// the rest of the body moves over them. With p_i the place of point i against the root and w_i the
/// trust in its contact,
///
///   Δp_root = −Σ w_i Δp_i / Σ w_i     along the ground (zero velocity of the points on it), and
///   z_root  = z_ground − min_i (p_i − r_i)     so that nothing sinks and somebody stands.
///
/// One point is stood on: the one at most rest by its sensor and its height
/// (GroundContact::unrest), until another is clearly quieter. Those that move with it share the
/// weight, so that it passes from one point to the next as that comes down and the other lifts; the
/// place is the sum of the steps and never jumps. Dead reckoning by the supporting foot: Yuan &
/// Chen 2014, "Localization and velocity tracking of human via 3 IMU sensors", Sensors and
/// Actuators A 212:25–33; the choice of the point and the blending are ours.
///
/// Limits: the ground is one level plane. Feet in the air with nothing else on the ground (jumps)
/// are taken for feet on it. Without a usable leg (upper and lower) the root stays where it is.
///
/// Owned by one body's tracker. After construction nothing allocates. Thread-compatible.
class RootTracker {
 public:
  explicit RootTracker(const BodyDefinition& body, const RootTrackerConfig& config = {});

  /// A position of the pelvis from outside, true at `measured_at`; a time after the frame or more
  /// than 1 s before it is taken for the frame's. `cov_m2` zero: exact. Used with the next frame.
  /// Its height says how high the ground is.
  void OnPositionFix(const Eigen::Vector3d& p_earth_root_m, const Eigen::Matrix3d& cov_m2,
                     Time measured_at);

  /// The next pose does not follow from the last one by movement (other offsets, dimensions, a
  /// gap): the person stays where it is.
  void Restart() { started_ = false; }

  /// Takes over other dimensions; as Restart.
  void SetBody(const BodyDefinition& body);

  /// Moves `pose`, which Place put with its root at zero, to its place in the earth frame. Toes
  /// that are not measured are laid flat while the ball of their foot is on the ground.
  void Update(Time at, const PerSegment<SegmentMotion>& motion, BodyPose& pose);

  /// Bit i set: segment i is on the ground, as of the last Update.
  [[nodiscard]] std::uint32_t contacts() const { return contacts_; }
  [[nodiscard]] const Eigen::Vector3d& p_earth_root_m() const { return p_earth_root_m_; }
  /// Height of the ground in the earth frame.
  [[nodiscard]] double ground_m() const { return ground_m_; }

 private:
  struct Point {
    ContactPoint point;
    GroundContact contact;
    bool known = false;
    Eigen::Vector3d p_root_point_m = Eigen::Vector3d::Zero();    // earth axes
    Eigen::Vector2d moved_m = Eigen::Vector2d::Zero();           // along the ground, since then
    Eigen::Vector2d v_root_point_m_s = Eigen::Vector2d::Zero();  // smoothed
  };
  struct Fix {
    Eigen::Vector3d p_earth_root_m = Eigen::Vector3d::Zero();
    double var_along_m2 = 0.0;  // along the ground
    double var_up_m2 = 0.0;
    Time measured_at{};
  };

  bool LocatePoints(const PerSegment<SegmentMotion>& motion, const BodyPose& pose);
  void Observe(double dt_s, const PerSegment<SegmentMotion>& motion);
  void ChooseSupport();
  [[nodiscard]] Eigen::Vector2d Step();
  void TakeFix(Time at);
  void Correct(double dt_s);
  void LayToes(double dt_s, BodyPose& pose);

  RootTrackerConfig config_;
  std::vector<Point> points_;
  std::size_t support_ = 0;  // the point that is stood on
  double standing_root_m_ = 0.0;
  bool stands_ = false;   // some leg is usable
  bool started_ = false;  // there is a last frame to go on from
  bool fixed_ = false;    // a fix has been taken
  Time last_at_{};
  Eigen::Vector3d p_earth_root_m_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_earth_root_m_s_ = Eigen::Vector3d::Zero();
  double lowest_m_ = 0.0;  // of the points against the root, at their undersides
  double ground_m_ = 0.0;
  double sigma_along_m_ = 0.0;                              // of the root along the ground
  double sigma_up_m_ = 1.0;                                 // of the ground
  Eigen::Vector3d to_correct_m_ = Eigen::Vector3d::Zero();  // of the last fix, not made good yet
  std::optional<Fix> fix_;
  std::array<bool, 2> has_toe_{};     // right, left
  std::array<double, 2> toe_flat_{};  // right, left: 0 as the foot, 1 on the ground
  std::uint32_t contacts_ = 0;
};

}  // namespace limbcast::body
