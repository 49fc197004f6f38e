#include <cmath>

#include "common/body/limb_pull.hpp"
#include "services/posture/body_tracker.hpp"

namespace limbcast::posture {
namespace {

// Where a sensor sits on the pelvis is not known better, so no marker places the root better.
constexpr double kSigmaPlace_m = 0.01;
constexpr float kAxes = 3.0F;

}  // namespace

// Positions of this very tick take part in it: an older one would pull the limb to where it was.
void BodyTracker::UsePositions(Time at) {
  bool pulled = false;
  for (const body::SegmentDefinition& segment : definition_.segments) {
    const std::size_t i = body::Index(segment.segment);
    const Track& track = tracks_[i];
    sigmas_rad_[i] =
        std::isfinite(track.last.sigma_rad) ? track.last.sigma_rad / std::sqrt(kAxes) : 0.0F;
  }
  for (const body::SegmentDefinition& segment : definition_.segments) {
    const std::size_t i = body::Index(segment.segment);
    const Track& track = tracks_[i];
    if (!pose_.known[i] || !track.aligned || !track.last.has_position ||
        track.last.measured_at != at) {
      continue;
    }
    const Eigen::Vector3d p_m = track.last.p_earth_sensor_m.cast<double>();
    const Eigen::Matrix3d cov_m2 = track.last.cov_position_m2.cast<double>();
    if (track.last.position_reference == PositionReference::kEarth) {
      if (segment.segment == body::Segment::kPelvis && p_m.allFinite() && cov_m2.allFinite()) {
        root_.OnPositionFix(p_m - pose_.q_earth_segment[i] * sensor_places_m_[i],
                            cov_m2 + kSigmaPlace_m * kSigmaPlace_m * Eigen::Matrix3d::Identity(),
                            at);
      }
      continue;
    }
    const std::size_t from = body::Index(track.last.position_from);
    const Track& source = tracks_[from];
    if (!pose_.known[from] || !source.aligned || source.last.measured_at != at) {
      continue;
    }
    // Into the axes that the skeleton has: its heading may be corrected, or blending in.
    const Eigen::Quaterniond q_earth_raw =
        source.last.q_earth_sensor * source.alignment.q_sensor_segment();
    const Eigen::Quaterniond q_turn = pose_.q_earth_segment[from] * q_earth_raw.conjugate();
    const Eigen::Matrix3d R_turn = q_turn.normalized().toRotationMatrix();
    pulled = body::PullLimb({},
                            {.segment = segment.segment,
                             .p_segment_sensor_m = sensor_places_m_[i],
                             .from = track.last.position_from,
                             .p_from_sensor_m = sensor_places_m_[from],
                             .p_sensor_sensor_m = R_turn * p_m,
                             .cov_m2 = R_turn * cov_m2 * R_turn.transpose()},
                            sigmas_rad_, pose_) ||
             pulled;
  }
  if (pulled) {
    kinematics_.Fill(pose_);  // hands and feet without a sensor go along
    if (config_.joint_limits) {
      kinematics_.LimitJoints(config_.joint_softness_rad, pose_);
    }
    kinematics_.Place(Eigen::Vector3d::Zero(), pose_);
  }
}

}  // namespace limbcast::posture
