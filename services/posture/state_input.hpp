#pragma once

#include <Eigen/Geometry>

#include "common/base/ids.hpp"
#include "common/base/time.hpp"
#include "common/base/verdict.hpp"
#include "common/body/segment_state.hpp"
#include "services/posture/confidence.hpp"

namespace limbcast::posture {

/// The part of a SegmentState that posture computes with; fixed size, so that queues do not
/// allocate.
struct StateInput {
  BodyId body_id;
  SensorUid sensor_uid;
  body::Segment segment = body::Segment::kPelvis;
  SampleVerdict verdict = SampleVerdict::kNoData;
  bool started = false;
  bool degraded = false;
  MagneticState magnetic_state = MagneticState::kUnused;
  HeadingReference heading = HeadingReference::kArbitrary;
  float sigma_rad = 0.0F;
  Time measured_at{};
  body::StageTimes stages;  ///< posture_received_at set
  Eigen::Quaterniond q_earth_sensor = Eigen::Quaterniond::Identity();
  Eigen::Vector3f w_earth_sensor_in_sensor_rad_s = Eigen::Vector3f::Zero();
  Eigen::Vector3f free_accel_in_earth_m_s2 = Eigen::Vector3f::Zero();
  bool has_position = false;
  PositionReference position_reference = PositionReference::kEarth;
  body::Segment position_from = body::Segment::kPelvis;
  Eigen::Vector3f p_earth_sensor_m = Eigen::Vector3f::Zero();
  Eigen::Matrix3f cov_position_m2 = Eigen::Matrix3f::Zero();
};

[[nodiscard]] inline StateInput MakeStateInput(const body::SegmentState& state, Time received_at) {
  StateInput input{.body_id = state.body_id,
                   .sensor_uid = state.sensor_uid,
                   .segment = state.segment,
                   .verdict = state.verdict,
                   .started = state.started,
                   .degraded = state.degraded,
                   .magnetic_state = state.magnetic_state,
                   .heading = state.heading,
                   .sigma_rad = SigmaOf(state.cov_orientation_rad2),
                   .measured_at = state.measured_at,
                   .stages = state.stages,
                   .q_earth_sensor = state.q_earth_sensor,
                   .w_earth_sensor_in_sensor_rad_s = state.w_earth_sensor_in_sensor_rad_s,
                   .free_accel_in_earth_m_s2 = state.free_accel_in_earth_m_s2,
                   .has_position = state.has_position,
                   .position_reference = state.position_reference,
                   .position_from = state.position_from,
                   .p_earth_sensor_m = state.p_earth_sensor_m,
                   .cov_position_m2 = state.cov_position_m2};
  input.stages.posture_received_at = received_at;
  return input;
}

}  // namespace limbcast::posture
