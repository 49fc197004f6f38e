#include "common/body/functional_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "common/body/gait.hpp"
#include "common/body/heading_graph.hpp"
#include "common/body/horizontal_axis.hpp"
#include "common/body/joint_heading.hpp"
#include "common/math/angles.hpp"
#include "common/math/rotation.hpp"

// Notation: E earth frame of one sensor, S sensor, B segment; θ direction of walking in E.

namespace limbcast::body {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree_rad = kPi / 180.0;
constexpr double kSmoothing_s = 0.12;
constexpr double kMinStrides = 5.0;
/// A joint is not quite a ball in a socket, and skin moves: no turn is surer than this.
constexpr double kJointFloor_rad = 4.0 * kDegree_rad;
/// ... and a misfit that is no noise is a model that does not hold.
constexpr double kJointMisfit_rad = 20.0 * kDegree_rad;
/// Magnetometers indoors, and sensors with a filter of their own.
constexpr double kCommonHeading_rad = 8.0 * kDegree_rad;

/// How far a segment's heading in the stance, and on the average of walking, is from the body's.
struct FacingSpread {
  double standing_rad;
  double walking_rad;
};

FacingSpread SpreadOf(Segment segment) {
  const auto degrees = [](double standing, double walking) {
    return FacingSpread{standing * kDegree_rad, walking * kDegree_rad};
  };
  switch (segment) {
    case Segment::kRightFoot:
    case Segment::kLeftFoot:
    case Segment::kRightToe:
    case Segment::kLeftToe:
      return degrees(8.0, 10.0);
    case Segment::kRightUpperLeg:
    case Segment::kLeftUpperLeg:
    case Segment::kRightLowerLeg:
    case Segment::kLeftLowerLeg:
      return degrees(8.0, 5.0);
    case Segment::kRightUpperArm:
    case Segment::kLeftUpperArm:
      return degrees(10.0, 30.0);
    case Segment::kRightForeArm:
    case Segment::kLeftForeArm:
    case Segment::kRightHand:
    case Segment::kLeftHand:
      return degrees(12.0, 40.0);
    case Segment::kRightShoulder:
    case Segment::kLeftShoulder:
      return degrees(6.0, 8.0);
    default:
      return degrees(4.0, 4.0);
  }
}

/// Index of the nearest ancestor that has a sensor; of the head and neck without one on the chest
/// and so on whatever the tree leads to.
std::ptrdiff_t ParentWithSensor(const std::vector<SmoothMotion>& motions, Segment segment) {
  for (auto parent = ParentOf(segment); parent; parent = ParentOf(*parent)) {
    const auto found = std::find_if(motions.begin(), motions.end(),
                                    [&](const auto& motion) { return motion.segment == *parent; });
    if (found != motions.end()) {
      return found - motions.begin();
    }
  }
  return -1;
}

struct Evidence {
  std::vector<DirectionObservation> directions;
  std::vector<TurnObservation> turns;
};

Evidence Collect(const std::vector<SmoothMotion>& motions, double rate_hz, std::size_t half_stride,
                 bool common_heading) {
  Evidence evidence;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const SmoothMotion& motion = motions[i];
    const bool trunk = !IsLeg(motion.segment) && !IsArm(motion.segment);
    const auto axis_of = [&](const std::vector<Eigen::Vector3d>& vectors) {
      return trunk ? SymmetricAxis(vectors, half_stride) : PrincipalAxis(vectors);
    };
    const HorizontalAxis along = axis_of(motion.accel_in_earth_m_s2);
    evidence.directions.push_back({i, along.direction_rad, along.sigma_rad});
    const HorizontalAxis across = axis_of(motion.w_earth_sensor_in_earth_rad_s);
    // A limb swings about the axis across the way it goes; what leads it sideways is not wrong, but
    // says less than its acceleration.
    evidence.directions.push_back(
        {i, across.direction_rad - kPi / 2.0, std::sqrt(2.0) * across.sigma_rad});

    const std::ptrdiff_t parent = ParentWithSensor(motions, motion.segment);
    if (parent < 0) {
      continue;
    }
    const auto joint = FitJointHeading(motions[static_cast<std::size_t>(parent)], motion, rate_hz);
    if (joint) {
      const double sigma_rad = std::min(
          kPi, std::hypot(kJointFloor_rad, joint->sigma_rad) + kJointMisfit_rad * joint->misfit);
      evidence.turns.push_back({static_cast<std::size_t>(parent), i, joint->turn_rad, sigma_rad});
    }
    if (common_heading) {
      evidence.turns.push_back({static_cast<std::size_t>(parent), i, 0.0, kCommonHeading_rad});
    }
  }
  return evidence;
}

/// Rotation about the axis to the left of `direction_rad`, of what turned since the stance: the
/// mean over the walk of the twist.
double MeanPitch_rad(const SmoothMotion& motion, const Eigen::Quaterniond& q_ES_standing,
                     double direction_rad) {
  const Eigen::Vector3d left(-std::sin(direction_rad), std::cos(direction_rad), 0.0);
  double sum_rad = 0.0;
  for (const Eigen::Quaterniond& q : motion.q_earth_sensor) {
    const Eigen::Quaterniond turned = q * q_ES_standing.conjugate();
    sum_rad += math::WrappedAngle_rad(2.0 * std::atan2(turned.vec().dot(left), turned.w()));
  }
  return sum_rad / static_cast<double>(motion.q_earth_sensor.size());
}

/// Positive: the directions are forward. A bend of a knee by kBend_rad counts as 1.
double Forwardness(const FunctionalInput& input, const std::vector<SmoothMotion>& motions,
                   const std::vector<double>& direction_rad, double half_stride_s) {
  constexpr double kBend_rad = 0.12;
  constexpr double kPendulum = 2.0;
  const double rate_hz = input.walking.rate_hz;
  const auto half_stride = static_cast<std::size_t>(std::lround(half_stride_s * rate_hz));
  double sum = 0.0;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const Segment segment = motions[i].segment;
    if (IsTrunk(segment)) {
      sum += kPendulum * PendulumForwardness(motions[i].accel_in_earth_m_s2, direction_rad[i],
                                             half_stride, rate_hz);
    }
    const bool knee = segment == Segment::kRightLowerLeg || segment == Segment::kLeftLowerLeg;
    const bool elbow = segment == Segment::kRightForeArm || segment == Segment::kLeftForeArm;
    const std::ptrdiff_t parent = ParentWithSensor(motions, segment);
    // Arms that were held out in the stance say nothing of how elbows bend in the walk.
    const bool bends = knee || (elbow && input.standing.pose == ReferencePose::kNPose);
    if (!bends || parent < 0 ||
        ParentOf(segment) != motions[static_cast<std::size_t>(parent)].segment) {
      continue;
    }
    const auto p = static_cast<std::size_t>(parent);
    const auto standing = [&](Segment s) { return input.standing.q_earth_sensor[Index(s)]; };
    const double bend_rad =
        MeanPitch_rad(motions[i], standing(segment), direction_rad[i]) -
        MeanPitch_rad(motions[p], standing(motions[p].segment), direction_rad[p]);
    // A knee bends +y, an elbow −y; an elbow may hang straight, or be bent in the stance.
    sum += (knee ? bend_rad : -0.5 * bend_rad) / kBend_rad;
  }
  return sum;
}

double Weighted(double a, double sigma_a, double b, double sigma_b) {
  const double wa = 1.0 / (sigma_a * sigma_a);
  const double wb = 1.0 / (sigma_b * sigma_b);
  return (wa * a + wb * b) / (wa + wb);
}

/// Mean over the walk of the heading gained since the stance, on the circle, of the axis that was
/// to the left of `direction_rad` then: bending about it does not count.
double MeanHeading_rad(const SmoothMotion& motion, const Eigen::Quaterniond& q_ES_standing,
                       double direction_rad) {
  math::AngleMean mean;
  const Eigen::Vector3d left_E(-std::sin(direction_rad), std::cos(direction_rad), 0.0);
  const Eigen::Vector3d left_S = q_ES_standing.conjugate() * left_E;
  for (const Eigen::Quaterniond& q : motion.q_earth_sensor) {
    const Eigen::Vector3d now_E = q * left_S;
    mean.Add(std::atan2(-now_E.x(), now_E.y()) - direction_rad);
  }
  return mean.Mean_rad();
}

std::string Whole(double value) { return std::to_string(std::lround(value)); }

std::string Degrees(double angle_rad) { return Whole(angle_rad / kDegree_rad) + " deg"; }

/// With one decimal.
std::string Tenths(double value) {
  const long tenths = std::lround(std::abs(value) * 10.0);
  return (value < 0.0 ? "-" : "") + std::to_string(tenths / 10) + "." + std::to_string(tenths % 10);
}

/// The third step: from directions of walking to offsets and heading corrections.
void Place(const FunctionalInput& input, const std::vector<SmoothMotion>& motions,
           const HeadingGraphSolution& graph, FunctionalFit& fit) {
  const bool n_pose = input.standing.pose == ReferencePose::kNPose;
  // Heading gained since the stance, in the frame of the walk; and the facing of the stance in it.
  std::vector<double> gained_rad;
  math::AngleMean stance;
  math::AngleMean direction;
  for (const SmoothMotion& motion : motions) {
    gained_rad.push_back(MeanHeading_rad(motion,
                                         input.standing.q_earth_sensor[Index(motion.segment)],
                                         graph.direction_rad[gained_rad.size()]));
    const FacingSpread spread = SpreadOf(motion.segment);
    const double weight =
        1.0 / (spread.standing_rad * spread.standing_rad + spread.walking_rad * spread.walking_rad);
    if (n_pose || !IsArm(motion.segment)) {
      stance.Add(-gained_rad.back(), weight);
    }
  }
  for (const double direction_rad : graph.direction_rad) {
    direction.Add(direction_rad);
  }
  const double stance_rad = stance.Mean_rad();
  const double facing_rad =
      input.common_heading ? stance_rad + direction.Mean_rad() : input.facing_rad;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const Segment segment = motions[i].segment;
    const FacingSpread spread = SpreadOf(segment);
    const double walked_rad = math::WrappedAngle_rad(-gained_rad[i] - stance_rad);
    const double of_stance_rad =
        n_pose || !IsArm(segment)
            ? Weighted(0.0, spread.standing_rad, walked_rad, spread.walking_rad)
            : 0.0;
    const double theta_rad = graph.direction_rad[i];
    SegmentFit one;
    one.segment = segment;
    one.heading_correction_rad = math::WrappedAngle_rad(facing_rad - stance_rad - theta_rad);
    const Eigen::Quaterniond q_earth_segment =
        HeadingRotation(theta_rad + stance_rad + of_stance_rad) *
        ReferenceOrientation(input.standing.pose, segment);
    one.q_sensor_segment = math::Canonical(
        (input.standing.q_earth_sensor[Index(segment)].conjugate() * q_earth_segment).normalized());
    one.sigma_rad = graph.sigma_rad[i] * std::max(1.0, graph.misfit[i]);
    if (one.sigma_rad > kMaxFitSigma_rad) {
      one.doubt = "its heading is known to " + Degrees(one.sigma_rad) + " only (limit " +
                  Degrees(kMaxFitSigma_rad) + "): it moved too little";
    }
    fit.segments.push_back(std::move(one));
  }
}

/// A walk, smooth and turned back to one direction, and what all sensors make of it.
struct SeenWalk {
  std::vector<SmoothMotion> motions;
  Gait gait;
  double walked_s = 0.0;
  HeadingGraphSolution graph;
};

Result<SeenWalk> Survey(const MotionRecord& walking, bool common_heading) {
  if (walking.segments.size() < 2) {
    return Error{ErrorCode::kInvalidArgument,
                 "functional alignment needs at least 2 sensors, has " +
                     std::to_string(walking.segments.size())};
  }
  const double rate_hz = walking.rate_hz;
  SeenWalk seen;
  seen.motions = Smooth(walking, kSmoothing_s);
  const Stretch walk = LongestActivity(seen.motions, rate_hz);
  Cut(walk.begin, walk.end, seen.motions);
  seen.walked_s = static_cast<double>(walk.end - walk.begin) / rate_hz;
  const auto gait = FindGait(seen.motions, rate_hz);
  if (!gait) {
    return Error{ErrorCode::kInvalidArgument,
                 "no steady walking in these " +
                     Whole(static_cast<double>(walking.size()) / rate_hz) + " s: moved for " +
                     Whole(seen.walked_s) + " s on end, but no stride repeats"};
  }
  if (seen.walked_s / gait->stride_s < kMinStrides) {
    return Error{ErrorCode::kInvalidArgument, "walked " + Tenths(seen.walked_s / gait->stride_s) +
                                                  " strides, needs at least " + Whole(kMinStrides)};
  }
  seen.gait = *gait;
  const auto stride = static_cast<std::size_t>(std::lround(gait->stride_s * rate_hz));
  const std::vector<Eigen::Quaterniond>& leader = seen.motions.front().q_earth_sensor;
  TurnBack(MovingMean(HeadingSince_rad(leader.front(), leader), stride), seen.motions);
  const Evidence evidence = Collect(seen.motions, rate_hz, stride / 2, common_heading);
  seen.graph = SolveHeadingGraph(seen.motions.size(), evidence.directions, evidence.turns);
  return seen;
}

Status CheckInput(const FunctionalInput& input) {
  for (const SegmentRecord& motion : input.walking.segments) {
    if (!input.standing.known[Index(motion.segment)] ||
        motion.q_earth_sensor.size() != input.walking.size() ||
        motion.accel_in_earth_m_s2.size() != input.walking.size()) {
      return Error{ErrorCode::kInvalidArgument, std::string(ToString(motion.segment)) +
                                                    " was not seen both standing and walking"};
    }
  }
  const double tilt_rad = StanceTilt_rad(input.standing, input.walking);
  if (tilt_rad > kMaxStanceTilt_rad) {
    return Error{ErrorCode::kInvalidArgument,
                 "the reference pose was no upright stance: trunk and legs are inclined " +
                     Degrees(tilt_rad) + " otherwise than while walking (limit " +
                     Degrees(kMaxStanceTilt_rad) + ")"};
  }
  return Ok();
}

}  // namespace

double StanceTilt_rad(const StandingPose& standing, const MotionRecord& walking) {
  double sum_rad = 0.0;
  double count = 0.0;
  for (const SegmentRecord& motion : walking.segments) {
    if (IsArm(motion.segment)) {
      continue;
    }
    count += 1.0;
    if (!standing.known[Index(motion.segment)] || motion.q_earth_sensor.empty()) {
      sum_rad += kPi;
      continue;
    }
    const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
    Eigen::Vector3d up_S = Eigen::Vector3d::Zero();
    for (const Eigen::Quaterniond& q : motion.q_earth_sensor) {
      up_S += q.conjugate() * z;
    }
    const Eigen::Vector3d up_standing_S =
        standing.q_earth_sensor[Index(motion.segment)].conjugate() * z;
    sum_rad += std::atan2(up_S.cross(up_standing_S).norm(), up_S.dot(up_standing_S));
  }
  return count > 0.0 ? sum_rad / count : 0.0;
}

Result<std::vector<WalkingDirection>> FindWalkingDirections(const MotionRecord& walking) {
  auto seen = Survey(walking, false);
  if (!seen) {
    return seen.error();
  }
  std::vector<WalkingDirection> directions;
  for (std::size_t i = 0; i < seen->motions.size(); ++i) {
    directions.push_back(
        {.segment = seen->motions[i].segment,
         .direction_rad = seen->graph.direction_rad[i],
         .sigma_rad = seen->graph.sigma_rad[i] * std::max(1.0, seen->graph.misfit[i])});
  }
  return directions;
}

Result<FunctionalFit> FitFunctionalAlignment(const FunctionalInput& input) {
  if (Status checked = CheckInput(input); !checked) {
    return checked.error();
  }
  auto seen = Survey(input.walking, input.common_heading);
  if (!seen) {
    return seen.error();
  }
  FunctionalFit fit;
  fit.stride_s = seen->gait.stride_s;
  fit.walked_s = seen->walked_s;
  fit.strides = seen->walked_s / seen->gait.stride_s;
  HeadingGraphSolution& graph = seen->graph;
  fit.forwardness =
      Forwardness(input, seen->motions, graph.direction_rad, seen->gait.stride_s / 2.0);
  if (fit.forwardness < 0.0) {
    for (double& direction_rad : graph.direction_rad) {
      direction_rad = math::WrappedAngle_rad(direction_rad + kPi);
    }
    fit.forwardness = -fit.forwardness;
  }
  if (fit.forwardness < kMinForwardness) {
    return Error{ErrorCode::kInvalidArgument,
                 "cannot tell forward from backward (" + Tenths(fit.forwardness) + ", needs " +
                     Tenths(kMinForwardness) + "): walk faster, with knees and arms free"};
  }
  Place(input, seen->motions, graph, fit);
  return fit;
}

}  // namespace limbcast::body
