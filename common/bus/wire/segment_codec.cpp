#include "common/bus/wire/codec_impl.hpp"

namespace limbcast::bus {

template <typename V, Of<body::SegmentState> D, typename W>
void KeyFields(V& field, D& d, W& w) {
  field("body_id", d.body_id, w.body_id());
  field("segment", d.segment, w.segment());
  field("slot", d.slot, w.slot());
}
template <typename V, Of<body::SegmentState> D, typename W>
void Fields(V& field, D& d, W& w) {
  KeyFields(field, d, w);
  field("sensor_uid", d.sensor_uid, w.sensor_uid());
  field("sequence", d.sequence, w.sample_number());
  field("verdict", d.verdict, w.verdict());
  field("started", d.started, w.started());
  field("degraded", d.degraded, w.degraded());
  field("at_rest", d.at_rest, w.at_rest());
  field("magnetic_state", d.magnetic_state, w.magnetic_state());
  field("heading", d.heading, w.heading());
  field("measured_at", d.measured_at, w.measured_at_ns());
  field("stages", d.stages, w.stages());
  field("q_earth_sensor", d.q_earth_sensor, w.q_earth_sensor());
  field("w_earth_sensor_in_sensor_rad_s", d.w_earth_sensor_in_sensor_rad_s,
        w.w_earth_sensor_in_sensor_rad_s());
  field("free_accel_in_earth_m_s2", d.free_accel_in_earth_m_s2, w.free_accel_in_earth_m_s2());
  field("cov_orientation_rad2", d.cov_orientation_rad2, w.cov_orientation_rad2());
  field("has_position", d.has_position, w.has_position());
  field("p_earth_sensor_m", d.p_earth_sensor_m, w.p_earth_sensor_m());
  field("v_earth_sensor_m_s", d.v_earth_sensor_m_s, w.v_earth_sensor_m_s());
  field("cov_position_m2", d.cov_position_m2, w.cov_position_m2());
  field("filter", d.filter, w.filter());
  field("lost_count", d.lost_count, w.lost_count());
  field("verdicts", d.verdicts, w.verdict_counts());
  field("position_reference", d.position_reference, w.position_reference());
  field("position_from", d.position_from, w.position_from());
  field("position_fill", d.position_fill, w.position_fill());
}

template <typename V, Of<body::SegmentFrame> D, typename W>
void KeyFields(V& field, D& d, W& w) {
  field("body_id", d.body_id, w.body_id());
}
template <typename V, Of<body::SegmentFrame> D, typename W>
void Fields(V& field, D& d, W& w) {
  KeyFields(field, d, w);
  field.List("states", d.states, w.states(), body::kMaxStatesPerFrame);
}

template <typename V, Of<body::SegmentTruth> D, typename W>
void KeyFields(V& field, D& d, W& w) {
  field("body_id", d.body_id, w.body_id());
  field("segment", d.segment, w.segment());
}
template <typename V, Of<body::SegmentTruth> D, typename W>
void Fields(V& field, D& d, W& w) {
  KeyFields(field, d, w);
  field("sensor_uid", d.sensor_uid, w.sensor_uid());
  field("measured_at", d.measured_at, w.measured_at_ns());
  field("sensor_valid", d.sensor_valid, w.sensor_valid());
  field("segment_valid", d.segment_valid, w.segment_valid());
  field("q_earth_sensor", d.q_earth_sensor, w.q_earth_sensor());
  field("q_earth_segment", d.q_earth_segment, w.q_earth_segment());
  field("p_earth_segment_m", d.p_earth_segment_m, w.p_earth_segment_m());
  field("p_earth_sensor_m", d.p_earth_sensor_m, w.p_earth_sensor_m());
}

template struct Codec<body::SegmentState>;
template struct Codec<body::SegmentFrame>;
template struct Codec<body::SegmentTruth>;

}  // namespace limbcast::bus
