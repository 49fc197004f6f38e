#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/body/body_definition.hpp"
#include "common/body/joint_angles.hpp"
#include "common/body/segment.hpp"

namespace limbcast::body {

/// One value for each segment, reached by Index(segment); those a body does not have are unused.
template <typename T>
using PerSegment = std::array<T, kSegmentCount>;

/// Where a person's segments are. `known` says which orientations are measured (or held); the
/// others are filled in by ForwardKinematics.
struct BodyPose {
  PerSegment<bool> known{};
  PerSegment<float> confidence{};  ///< 0 to 1; of the known ones given, of the others computed
  PerSegment<Eigen::Quaterniond> q_earth_segment =
      Filled<Eigen::Quaterniond>(Eigen::Quaterniond::Identity());
  PerSegment<Eigen::Vector3d> p_earth_segment_m =
      Filled<Eigen::Vector3d>(Eigen::Vector3d::Zero());  ///< inboard ends

 private:
  template <typename T>
  static PerSegment<T> Filled(const T& value) {
    PerSegment<T> all;
    all.fill(value);
    return all;
  }
};

/// From segment orientations to a whole person: fills what carries no sensor, limits joints, and
/// sums the vectors of Bachmann Eq. (35). Made once for a definition; no allocation afterwards.
/// Const functions are thread-safe.
class ForwardKinematics {
 public:
  /// `body` must be valid (Validate).
  explicit ForwardKinematics(const BodyDefinition& body);

  /// Gives every segment that is not known an orientation and a confidence, in this order:
  ///  - pelvis: upright, with the heading of the first known one of T8, L3, L5, T12, the upper
  ///    legs, the head; if none is known, as it was;
  ///  - L5, L3, T12, T8 between two known ones of the trunk: interpolated, each vertebra the same
  ///    share of the turn (L5 ¼, L3 ½, T12 ¾ between pelvis and T8); above the last: as that one;
  ///  - neck: half way between T8 and a known head;
  ///  - shoulders of a measured arm: as T8, raised by 0.12 of what the arm is elevated beyond 30°.
  ///  The
  ///    rhythm of Inman, Saunders & Abbott 1944, J. Bone Joint Surg. 26:1–30; their clavicle rises
  ///    more, but its outboard end, which is all we have, follows later measurements (ours);
  ///  - all others (hands, feet, toes, whatever lost its sensor): as their parent, so the joint is
  ///    as in the reference pose. (RootTracker lays toes flat while they are on the ground.)
  /// Confidence: kFillConfidence times the least of the sources; a pelvis that is guessed has 0.
  void Fill(BodyPose& pose) const;
  static constexpr float kFillConfidence = 0.8F;

  /// Brings joints softly back to their limits: what lies beyond by x comes to lie beyond by
  /// s·(1 − e^(−x/s)). Hips, ankles and wrists by their angles (joint_limits.hpp), the others by
  /// the rotation vector about their parent, where the definition gives limits (knees, elbows).
  /// Parents first; a child keeps its orientation in the earth frame.
  /// @param softness_rad  s, > 0: the most by which a limit is overstepped.
  void LimitJoints(double softness_rad, BodyPose& pose) const;

  /// Inboard ends by vector sums from the root outwards, Eq. (35):
  ///   p_earth_segment = p_earth_parent + q_earth_parent · p_parent_segment
  void Place(const Eigen::Vector3d& p_earth_root_m, BodyPose& pose) const;

  /// Outboard end of a segment of a placed pose, in the earth frame.
  [[nodiscard]] Eigen::Vector3d End_m(Segment segment, const BodyPose& pose) const;

  /// The segments of the body, parents first.
  [[nodiscard]] const std::vector<Segment>& segments() const { return segments_; }

 private:
  static constexpr std::uint8_t kNone = 0xFF;
  struct Link {
    std::uint8_t segment = 0;
    std::uint8_t parent = kNone;
    bool limited = false;        // by the definition
    std::optional<Joint> joint;  // limited by its angles
    Eigen::Vector3d p_parent_segment_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d p_segment_end_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d joint_min_rad = Eigen::Vector3d::Zero();
    Eigen::Vector3d joint_max_rad = Eigen::Vector3d::Zero();
  };
  void FillPelvis(BodyPose& pose, PerSegment<bool>& done) const;
  void FillTrunk(BodyPose& pose, PerSegment<bool>& done) const;
  void FillShoulder(Segment segment, Joint joint, BodyPose& pose, PerSegment<bool>& done) const;
  [[nodiscard]] static Eigen::Quaterniond LimitedAsHinge(const Link& link,
                                                         const Eigen::Quaterniond& q_parent_segment,
                                                         double softness_rad);

  std::vector<Link> links_;  // parents first
  std::vector<Segment> segments_;
  std::vector<std::uint8_t> trunk_;  // of pelvis, L5, L3, T12, T8 those that the body has
  PerSegment<bool> has_{};
  PerSegment<Eigen::Vector3d> p_segment_end_m_{};
};

}  // namespace limbcast::body
