#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/body/alignment.hpp"
#include "common/body/forward_kinematics.hpp"
#include "common/body/motion_record.hpp"

namespace limbcast::body {

/// The person in the reference pose, by each sensor in its own earth frame.
struct StandingPose {
  ReferencePose pose = ReferencePose::kNPose;
  PerSegment<bool> known{};
  PerSegment<Eigen::Quaterniond> q_earth_sensor{};
};

/// What is known beside the movement.
struct FunctionalInput {
  StandingPose standing;
  MotionRecord walking;  ///< a few strides and more; turns are allowed, the pelvis takes them out
  /// Heading of the person in the reference pose, in the frame that the body shall have.
  double facing_rad = 0.0;
  /// True: the sensors have a common idea of heading (magnetometers), good to some degrees. Then
  /// `facing_rad` means nothing: the body faces as they say, and corrections are about zero. False:
  /// each has its own.
  bool common_heading = false;
};

/// How one sensor sits, and how sure that is.
struct SegmentFit {
  Segment segment = Segment::kPelvis;
  Eigen::Quaterniond q_sensor_segment = Eigen::Quaterniond::Identity();
  double heading_correction_rad = 0.0;  ///< in force at the time of the walk
  double sigma_rad = 0.0;               ///< of the turn about the vertical, 1σ
  std::string doubt;                    ///< empty, or why this segment is not to be trusted
};

/// A whole person, and what it is based on.
struct FunctionalFit {
  std::vector<SegmentFit> segments;  ///< in the order of the record
  double stride_s = 0.0;
  double strides = 0.0;
  double walked_s = 0.0;  ///< the part of the record that was used
  /// log-odds-like sum of what tells forward from backward; at least kMinForwardness.
  double forwardness = 0.0;
};

inline constexpr double kMinForwardness = 2.0;
/// A fit less sure than this has a doubt.
inline constexpr double kMaxFitSigma_rad = 0.26;  // 15°

/// Sensor-to-segment alignment, and the heading of sensors that have no magnetometer, from one
/// stance and some walking. In the stance gravity gives each segment's inclination (Bachmann Eq.
/// 34 for the two tilts); open are one turn of the mounting about the vertical and one heading for
/// each sensor. Walking gives them:
///
///  1. The way the person walks, in the earth frame of each sensor: the line along which a limb's
///     acceleration scatters and across which it turns (`PrincipalAxis`); for the trunk what
///     repeats with every step (`SymmetricAxis`); and between neighbours the turn that makes their
///     joint one point (`FitJointHeading`). All of them together by weighted least squares
///     (`SolveHeadingGraph`).
///  2. Forward or backward, once for the whole body: knees and elbows bend one way only, and the
///     trunk is an inverted pendulum (`PendulumForwardness`).
///  3. The stance again: all segments face one way in it, and they do so on the average of walking.
///     Trunk and legs take the weighted mean of both; arms, which hang turned while they swing,
///     mostly the stance.
///
/// Refuses, saying why: no walking in the record, less than five strides, the stance was no stance
/// (trunk or legs more than kMaxStanceTilt_rad from how they are while walking), no telling forward
/// from backward, fewer than two sensors.
[[nodiscard]] Result<FunctionalFit> FitFunctionalAlignment(const FunctionalInput& input);

inline constexpr double kMaxStanceTilt_rad = 0.6;

/// The way a person walks as one sensor sees it.
struct WalkingDirection {
  Segment segment = Segment::kPelvis;
  double direction_rad = 0.0;  ///< in the sensor's earth frame; forward or backward, alike for all
  double sigma_rad = 0.0;
};

/// The first step alone, without a stance: how the sensors' earth frames are turned against each
/// other. In the order of the record. Refuses without walking, as FitFunctionalAlignment.
[[nodiscard]] Result<std::vector<WalkingDirection>> FindWalkingDirections(
    const MotionRecord& walking);

/// Mean angle by which trunk and legs are inclined otherwise in `standing` than while walking:
/// small for a person who stood, large for one who sat or lay. Segments that are not in both count
/// as π.
[[nodiscard]] double StanceTilt_rad(const StandingPose& standing, const MotionRecord& walking);

}  // namespace limbcast::body
