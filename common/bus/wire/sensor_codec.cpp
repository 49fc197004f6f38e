#include "common/bus/wire/codec_impl.hpp"

namespace limbcast::bus {

template <typename V, Of<sensing::MargSample> D, typename W>
void KeyFields(V& field, D& d, W& w) {
  field("sensor_uid", d.sensor_uid, w.sensor_uid());
}
template <typename V, Of<sensing::MargSample> D, typename W>
void Fields(V& field, D& d, W& w) {
  KeyFields(field, d, w);
  field("sequence", d.sequence, w.sample_number());
  field("flags", d.flags, w.flags());
  field("measured_at", d.measured_at, w.measured_at_ns());
  field("published_at", d.published_at, w.published_at_ns());
  field("gyro_rad_s", d.gyro_rad_s, w.gyro_rad_s());
  field("accel_m_s2", d.accel_m_s2, w.accel_m_s2());
  field("mag_tesla", d.mag_tesla, w.mag_tesla());
  field("temperature_celsius", d.temperature_celsius, w.temperature_celsius());
}

template <typename V, Of<sensing::MargFrame> D, typename W>
void KeyFields(V& field, D& d, W& w) {
  field("body_id", d.body_id, w.body_id());
  field("gateway", d.gateway, w.gateway());
}
template <typename V, Of<sensing::MargFrame> D, typename W>
void Fields(V& field, D& d, W& w) {
  KeyFields(field, d, w);
  field.List("samples", d.samples, w.samples(), sensing::kMaxSamplesPerFrame);
}

template <typename V, Of<sensing::FusedOrientation> D, typename W>
void KeyFields(V& field, D& d, W& w) {
  field("sensor_uid", d.sensor_uid, w.sensor_uid());
}
template <typename V, Of<sensing::FusedOrientation> D, typename W>
void Fields(V& field, D& d, W& w) {
  KeyFields(field, d, w);
  field("sequence", d.sequence, w.sample_number());
  field("flags", d.flags, w.flags());
  field("measured_at", d.measured_at, w.measured_at_ns());
  field("published_at", d.published_at, w.published_at_ns());
  field("q_earth_sensor", d.q_earth_sensor, w.q_earth_sensor());
  field("heading", d.heading, w.heading());
  field("gyro_rad_s", d.gyro_rad_s, w.gyro_rad_s());
  field("accel_m_s2", d.accel_m_s2, w.accel_m_s2());
  field("sigma_rad", d.sigma_rad, w.sigma_rad());
}

template <typename V, Of<sensing::CoilPulse> D, typename W>
void Fields(V& field, D& d, W& w) {
  field("on_at", d.on_at, w.on_at_ns());
  field("off_at", d.off_at, w.off_at_ns());
  field("current_a", d.current_a, w.current_a());
  field("field_tesla", d.field_tesla, w.field_tesla());
  field("sigma_tesla", d.sigma_tesla, w.sigma_tesla());
  field("valid", d.valid, w.valid());
}
template <typename V, Of<sensing::CoilBurst> D, typename W>
void KeyFields(V& field, D& d, W& w) {
  field("sensor_uid", d.sensor_uid, w.sensor_uid());
  field("source_uid", d.source_uid, w.source_uid());
}
template <typename V, Of<sensing::CoilBurst> D, typename W>
void Fields(V& field, D& d, W& w) {
  KeyFields(field, d, w);
  field("sequence", d.sequence, w.sample_number());
  field("slot", d.slot, w.slot());
  field("measured_at", d.measured_at, w.measured_at_ns());
  field("published_at", d.published_at, w.published_at_ns());
  field("pulses", d.pulses, w.pulses());
}

template <typename V, Of<sensing::MarkerPosition> D, typename W>
void KeyFields(V& field, D& d, W& w) {
  field("body_id", d.body_id, w.body_id());
  field("marker", d.marker, w.marker());
}
template <typename V, Of<sensing::MarkerPosition> D, typename W>
void Fields(V& field, D& d, W& w) {
  KeyFields(field, d, w);
  field("sequence", d.sequence, w.sample_number());
  field("measured_at", d.measured_at, w.measured_at_ns());
  field("published_at", d.published_at, w.published_at_ns());
  field("p_earth_marker_m", d.p_earth_marker_m, w.p_earth_marker_m());
  field("sigma_m", d.sigma_m, w.sigma_m());
  field("visible", d.visible, w.visible());
}

template <typename V, Of<sensing::PositionFix> D, typename W>
void KeyFields(V& field, D& d, W& w) {
  field("body_id", d.body_id, w.body_id());
}
template <typename V, Of<sensing::PositionFix> D, typename W>
void Fields(V& field, D& d, W& w) {
  KeyFields(field, d, w);
  field("sequence", d.sequence, w.sample_number());
  field("measured_at", d.measured_at, w.measured_at_ns());
  field("published_at", d.published_at, w.published_at_ns());
  field("p_earth_body_m", d.p_earth_body_m, w.p_earth_body_m());
  field("cov_m2", d.cov_m2, w.cov_m2());
}

template <typename V, Of<sensing::SensorInfo> D, typename W>
void KeyFields(V& field, D& d, W& w) {
  field("sensor_uid", d.sensor_uid, w.sensor_uid());
}
template <typename V, Of<sensing::SensorInfo> D, typename W>
void Fields(V& field, D& d, W& w) {
  KeyFields(field, d, w);
  field("driver", d.driver, w.driver());
  field("serial", d.serial, w.serial());
  field("label", d.label, w.label());
  field("rate_hz", d.rate_hz, w.rate_hz());
  field("gyro_range_rad_s", d.gyro_range_rad_s, w.gyro_range_rad_s());
  field("accel_range_m_s2", d.accel_range_m_s2, w.accel_range_m_s2());
  field("mag_range_tesla", d.mag_range_tesla, w.mag_range_tesla());
  field("gyro_noise_rad_s_rthz", d.gyro_noise_rad_s_rthz, w.gyro_noise_rad_s_rthz());
  field("accel_noise_m_s2_rthz", d.accel_noise_m_s2_rthz, w.accel_noise_m_s2_rthz());
  field("mag_noise_tesla_rthz", d.mag_noise_tesla_rthz, w.mag_noise_tesla_rthz());
  field("calibration", d.calibration, w.calibration());
  field("calibrated_at", d.calibrated_at, w.calibrated_at_ns());
}

template struct Codec<sensing::MargSample>;
template struct Codec<sensing::MargFrame>;
template struct Codec<sensing::FusedOrientation>;
template struct Codec<sensing::CoilBurst>;
template struct Codec<sensing::MarkerPosition>;
template struct Codec<sensing::PositionFix>;
template struct Codec<sensing::SensorInfo>;

}  // namespace limbcast::bus
