#include "common/bus/wire/codec_impl.hpp"

namespace limbcast::bus {

inline constexpr std::size_t kMaxSegments = 32;
inline constexpr std::size_t kMaxJoints = 32;

template <typename V, Of<body::SegmentDefinition> D, typename W>
void Fields(V& field, D& d, W& w) {
  field("segment", d.segment, w.segment());
  field("tracked", d.tracked, w.tracked());
  field("sensor_uid", d.sensor_uid, w.sensor_uid());
  field("p_parent_segment_m", d.p_parent_segment_m, w.p_parent_segment_m());
  field("p_segment_end_m", d.p_segment_end_m, w.p_segment_end_m());
  field("q_sensor_segment", d.q_sensor_segment, w.q_sensor_segment());
  field("heading_correction_rad", d.heading_correction_rad, w.heading_correction_rad());
  field("aligned", d.aligned, w.aligned());
  field("joint_min_rad", d.joint_min_rad, w.joint_min_rad());
  field("joint_max_rad", d.joint_max_rad, w.joint_max_rad());
}
template <typename V, Of<body::BodyDefinition> D, typename W>
void KeyFields(V& field, D& d, W& w) {
  field("body_id", d.body_id, w.body_id());
}
template <typename V, Of<body::BodyDefinition> D, typename W>
void Fields(V& field, D& d, W& w) {
  KeyFields(field, d, w);
  field("revision", d.revision, w.revision());
  field("changed_at", d.changed_at, w.changed_at_ns());
  field("name", d.name, w.name());
  field("reference_pose", d.reference_pose, w.reference_pose());
  field("heading", d.heading, w.heading());
  field.List("segments", d.segments, w.segments(), kMaxSegments);
}

template <typename V, Of<body::SegmentPose> D, typename W>
void Fields(V& field, D& d, W& w) {
  field("segment", d.segment, w.segment());
  field("status", d.status, w.status());
  field("confidence", d.confidence, w.confidence());
  field("q_earth_segment", d.q_earth_segment, w.q_earth_segment());
  field("p_earth_segment_m", d.p_earth_segment_m, w.p_earth_segment_m());
}
template <typename V, Of<body::Skeleton> D, typename W>
void KeyFields(V& field, D& d, W& w) {
  field("body_id", d.body_id, w.body_id());
}
template <typename V, Of<body::Skeleton> D, typename W>
void Fields(V& field, D& d, W& w) {
  KeyFields(field, d, w);
  field("sequence", d.sequence, w.skeleton_number());
  field("definition_revision", d.definition_revision, w.definition_revision());
  field("contacts", d.contacts, w.contacts());
  field("measured_at", d.measured_at, w.measured_at_ns());
  field("stages", d.stages, w.stages());
  field("complete", d.complete, w.complete());
  field.List("segments", d.segments, w.segments(), kMaxSegments);
}

template <typename V, Of<body::JointAngle> D, typename W>
void Fields(V& field, D& d, W& w) {
  field("joint", d.joint, w.joint());
  field("near_singular", d.near_singular, w.near_singular());
  field("confidence", d.confidence, w.confidence());
  field("angle_rad", d.angle_rad, w.angle_rad());
}
template <typename V, Of<body::JointAngleFrame> D, typename W>
void KeyFields(V& field, D& d, W& w) {
  field("body_id", d.body_id, w.body_id());
}
template <typename V, Of<body::JointAngleFrame> D, typename W>
void Fields(V& field, D& d, W& w) {
  KeyFields(field, d, w);
  field("sequence", d.sequence, w.skeleton_number());
  field("measured_at", d.measured_at, w.measured_at_ns());
  field.List("joints", d.joints, w.joints(), kMaxJoints);
}

template struct Codec<body::BodyDefinition>;
template struct Codec<body::Skeleton>;
template struct Codec<body::JointAngleFrame>;

}  // namespace limbcast::bus
