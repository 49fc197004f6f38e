#include "tools/limbcast/json/topic_json.hpp"

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "common/sensing/coil_flags.hpp"
#include "tools/limbcast/json/value_json.hpp"

namespace limbcast::tool {
namespace {

using nlohmann::json;

json FlagsToJson(std::uint32_t flags) {
  static constexpr std::array<std::pair<std::uint32_t, std::string_view>, 14> kNames = {{
      {sensing::kGyroMissing, "gyro_missing"},
      {sensing::kAccelMissing, "accel_missing"},
      {sensing::kMagMissing, "mag_missing"},
      {sensing::kGyroSaturated, "gyro_saturated"},
      {sensing::kAccelSaturated, "accel_saturated"},
      {sensing::kMagSaturated, "mag_saturated"},
      {sensing::kMagHeld, "mag_held"},
      {sensing::kCoilPulseActive, "coil_pulse_active"},
      {sensing::kTemperatureMissing, "temperature_missing"},
      {sensing::kProbe, "probe"},
      {sensing::kCoilXOn, "coil_x_on"},
      {sensing::kCoilYOn, "coil_y_on"},
      {sensing::kCoilZOn, "coil_z_on"},
      {sensing::kCoilReversed, "coil_reversed"},
  }};
  json names = json::array();
  for (const auto& [bit, name] : kNames) {
    if ((flags & bit) != 0) {
      names.push_back(name);
    }
  }
  return names;
}

std::string_view RoleName(roster::Role role) {
  static constexpr std::array<std::string_view, 3> kNames = {"performer", "spectator", "operator"};
  const auto index = static_cast<std::size_t>(role);
  return index < kNames.size() ? kNames[index] : "unknown";
}

std::string_view CommandName(roster::CommandKind kind) {
  static constexpr std::array<std::string_view, 12> kNames = {
      "reference_pose", "reset_heading",          "set_dimensions", "select_filter",
      "undo",           "functional_calibration", "reset_mounting", "profile",
      "create_session", "close_session",          "leave_session",  "release_person"};
  const auto index = static_cast<std::size_t>(kind);
  return index < kNames.size() ? kNames[index] : "unknown";
}

json PulseToJson(const sensing::CoilPulse& pulse) {
  return {{"on_at", TimeToJson(pulse.on_at)},
          {"off_at", TimeToJson(pulse.off_at)},
          {"current_a", NumberToJson(pulse.current_a)},
          {"field_tesla", VectorToJson(pulse.field_tesla)},
          {"sigma_tesla", NumberToJson(pulse.sigma_tesla)},
          {"valid", pulse.valid}};
}

template <typename List, typename Convert>
json ListToJson(const List& list, Convert&& convert) {
  json result = json::array();
  for (const auto& element : list) {
    result.push_back(convert(element));
  }
  return result;
}

json DefinitionToJson(const body::SegmentDefinition& segment) {
  return {{"segment", body::ToString(segment.segment)},
          {"tracked", segment.tracked},
          {"sensor_uid", segment.sensor_uid.value},
          {"p_parent_segment_m", VectorToJson(segment.p_parent_segment_m)},
          {"p_segment_end_m", VectorToJson(segment.p_segment_end_m)},
          {"q_sensor_segment", QuaternionToJson(segment.q_sensor_segment)},
          {"aligned", segment.aligned},
          {"joint_min_rad", VectorToJson(segment.joint_min_rad)},
          {"joint_max_rad", VectorToJson(segment.joint_max_rad)}};
}

json PoseToJson(const body::SegmentPose& pose) {
  return {{"segment", body::ToString(pose.segment)},
          {"status", NameOf(pose.status)},
          {"confidence", NumberToJson(pose.confidence)},
          {"q_earth_segment", QuaternionToJson(pose.q_earth_segment)},
          {"p_earth_segment_m", VectorToJson(pose.p_earth_segment_m)}};
}

}  // namespace

json ToJson(const sensing::MargSample& value) {
  return {{"sensor_uid", value.sensor_uid.value},
          {"sequence", value.sequence},
          {"flags", FlagsToJson(value.flags)},
          {"measured_at", TimeToJson(value.measured_at)},
          {"published_at", TimeToJson(value.published_at)},
          {"gyro_rad_s", VectorToJson(value.gyro_rad_s)},
          {"accel_m_s2", VectorToJson(value.accel_m_s2)},
          {"mag_tesla", VectorToJson(value.mag_tesla)},
          {"temperature_celsius", NumberToJson(value.temperature_celsius)}};
}

json ToJson(const sensing::MargFrame& value) {
  return {{"body_id", value.body_id.value},
          {"gateway", value.gateway},
          {"samples", ListToJson(value.samples, [](const auto& s) { return ToJson(s); })}};
}

json ToJson(const sensing::FusedOrientation& value) {
  return {{"sensor_uid", value.sensor_uid.value},
          {"sequence", value.sequence},
          {"flags", FlagsToJson(value.flags)},
          {"measured_at", TimeToJson(value.measured_at)},
          {"published_at", TimeToJson(value.published_at)},
          {"q_earth_sensor", QuaternionToJson(value.q_earth_sensor)},
          {"heading", NameOf(value.heading)},
          {"gyro_rad_s", VectorToJson(value.gyro_rad_s)},
          {"accel_m_s2", VectorToJson(value.accel_m_s2)},
          {"sigma_rad", NumberToJson(value.sigma_rad)}};
}

json ToJson(const sensing::CoilBurst& value) {
  return {{"sensor_uid", value.sensor_uid.value},
          {"source_uid", value.source_uid.value},
          {"sequence", value.sequence},
          {"slot", value.slot},
          {"measured_at", TimeToJson(value.measured_at)},
          {"published_at", TimeToJson(value.published_at)},
          {"pulses", ListToJson(value.pulses, PulseToJson)}};
}

json ToJson(const sensing::MarkerPosition& value) {
  return {{"body_id", value.body_id.value},
          {"marker", value.marker},
          {"sequence", value.sequence},
          {"measured_at", TimeToJson(value.measured_at)},
          {"published_at", TimeToJson(value.published_at)},
          {"p_earth_marker_m", VectorToJson(value.p_earth_marker_m)},
          {"sigma_m", NumberToJson(value.sigma_m)},
          {"visible", value.visible}};
}

json ToJson(const sensing::PositionFix& value) {
  return {{"body_id", value.body_id.value},
          {"sequence", value.sequence},
          {"measured_at", TimeToJson(value.measured_at)},
          {"published_at", TimeToJson(value.published_at)},
          {"p_earth_body_m", VectorToJson(value.p_earth_body_m)},
          {"cov_m2", MatrixToJson(value.cov_m2)}};
}

json ToJson(const sensing::SensorInfo& value) {
  return {{"sensor_uid", value.sensor_uid.value},
          {"driver", value.driver},
          {"serial", value.serial},
          {"label", value.label},
          {"rate_hz", NumberToJson(value.rate_hz)},
          {"gyro_range_rad_s", NumberToJson(value.gyro_range_rad_s)},
          {"accel_range_m_s2", NumberToJson(value.accel_range_m_s2)},
          {"mag_range_tesla", NumberToJson(value.mag_range_tesla)},
          {"gyro_noise_rad_s_rthz", NumberToJson(value.gyro_noise_rad_s_rthz)},
          {"accel_noise_m_s2_rthz", NumberToJson(value.accel_noise_m_s2_rthz)},
          {"mag_noise_tesla_rthz", NumberToJson(value.mag_noise_tesla_rthz)},
          {"calibration", value.calibration},
          {"calibrated_at", TimeToJson(value.calibrated_at)}};
}

json ToJson(const body::SegmentState& value) {
  json result = {
      {"body_id", value.body_id.value},
      {"segment", body::ToString(value.segment)},
      {"slot", value.slot},
      {"sensor_uid", value.sensor_uid.value},
      {"sequence", value.sequence},
      {"verdict", ToString(value.verdict)},
      {"started", value.started},
      {"degraded", value.degraded},
      {"at_rest", value.at_rest},
      {"magnetic_state", NameOf(value.magnetic_state)},
      {"heading", NameOf(value.heading)},
      {"measured_at", TimeToJson(value.measured_at)},
      {"stages", StagesToJson(value.stages)},
      {"q_earth_sensor", QuaternionToJson(value.q_earth_sensor)},
      {"w_earth_sensor_in_sensor_rad_s", VectorToJson(value.w_earth_sensor_in_sensor_rad_s)},
      {"free_accel_in_earth_m_s2", VectorToJson(value.free_accel_in_earth_m_s2)},
      {"cov_orientation_rad2", MatrixToJson(value.cov_orientation_rad2)},
      {"filter", value.filter},
      {"lost_count", value.lost_count},
      {"verdicts", VerdictsToJson(value.verdicts)},
      {"has_position", value.has_position}};
  if (value.has_position) {
    result["p_earth_sensor_m"] = VectorToJson(value.p_earth_sensor_m);
    result["v_earth_sensor_m_s"] = VectorToJson(value.v_earth_sensor_m_s);
    result["cov_position_m2"] = MatrixToJson(value.cov_position_m2);
    result["position_from"] = value.position_reference == PositionReference::kEarth
                                  ? std::string_view("earth")
                                  : body::ToString(value.position_from);
    result["position_fill"] = ToString(value.position_fill);
  }
  return result;
}

json ToJson(const body::SegmentFrame& value) {
  return {{"body_id", value.body_id.value},
          {"states", ListToJson(value.states, [](const auto& s) { return ToJson(s); })}};
}

json ToJson(const body::SegmentTruth& value) {
  return {{"body_id", value.body_id.value},
          {"segment", body::ToString(value.segment)},
          {"sensor_uid", value.sensor_uid.value},
          {"measured_at", TimeToJson(value.measured_at)},
          {"sensor_valid", value.sensor_valid},
          {"segment_valid", value.segment_valid},
          {"q_earth_sensor", QuaternionToJson(value.q_earth_sensor)},
          {"q_earth_segment", QuaternionToJson(value.q_earth_segment)},
          {"p_earth_segment_m", VectorToJson(value.p_earth_segment_m)},
          {"p_earth_sensor_m", VectorToJson(value.p_earth_sensor_m)}};
}

json ToJson(const body::BodyDefinition& value) {
  return {{"body_id", value.body_id.value},
          {"revision", value.revision},
          {"changed_at", TimeToJson(value.changed_at)},
          {"name", value.name},
          {"reference_pose", value.reference_pose},
          {"heading", NameOf(value.heading)},
          {"segments", ListToJson(value.segments, DefinitionToJson)}};
}

json ToJson(const body::Skeleton& value) {
  return {{"body_id", value.body_id.value},
          {"sequence", value.sequence},
          {"definition_revision", value.definition_revision},
          {"measured_at", TimeToJson(value.measured_at)},
          {"stages", StagesToJson(value.stages)},
          {"complete", value.complete},
          {"contacts", value.contacts},
          {"segments", ListToJson(value.segments, PoseToJson)}};
}

json ToJson(const body::JointAngleFrame& value) {
  json joints = json::object();
  for (const body::JointAngle& angle : value.joints) {
    json& joint = joints[std::string(body::ToString(angle.joint))];
    const auto names = body::AngleNames(angle.joint);
    for (std::size_t i = 0; i < names.size(); ++i) {
      joint[std::string(names[i]) + "_rad"] =
          NumberToJson(angle.angle_rad[static_cast<Eigen::Index>(i)]);
    }
    joint["confidence"] = NumberToJson(angle.confidence);
    joint["near_singular"] = angle.near_singular;
  }
  return {{"body_id", value.body_id.value},
          {"sequence", value.sequence},
          {"measured_at", TimeToJson(value.measured_at)},
          {"joints", std::move(joints)}};
}

namespace {

json AssignmentToJson(const roster::SensorAssignment& sensor) {
  return {{"sensor_uid", sensor.sensor_uid.value}, {"segment", body::ToString(sensor.segment)}};
}

}  // namespace

json ToJson(const roster::RosterEntry& value) {
  return {{"body_id", value.body_id.value},
          {"revision", value.revision},
          {"session", value.session},
          {"person", value.person},
          {"sensors", ListToJson(value.sensors, AssignmentToJson)},
          {"coil_slot", value.coil_slot},
          {"coil_slots", value.coil_slots},
          {"coil_frame_us", value.coil_frame_us}};
}

json ToJson(const roster::SessionState& value) {
  return {{"session_id", value.session_id},
          {"revision", value.revision},
          {"name", value.name},
          {"partition", value.partition},
          {"open", value.open},
          {"performer_count", value.performer_count},
          {"created_at", TimeToJson(value.created_at)}};
}

json ToJson(const roster::JoinRequest& value) {
  return {{"client_uid", value.client_uid},
          {"request_id", value.request_id},
          {"session", value.session},
          {"person", value.person},
          {"role", RoleName(value.role)},
          {"sensors", ListToJson(value.sensors, AssignmentToJson)},
          {"wants_coil_slot", value.wants_coil_slot}};
}

json ToJson(const roster::JoinReply& value) {
  return {{"client_uid", value.client_uid}, {"request_id", value.request_id},
          {"accepted", value.accepted},     {"body_id", value.body_id.value},
          {"partition", value.partition},   {"message", value.message}};
}

json ToJson(const roster::Command& value) {
  return {{"client_uid", value.client_uid},
          {"request_id", value.request_id},
          {"body_id", value.body_id.value},
          {"kind", CommandName(value.kind)},
          {"text", value.text},
          {"numbers", ListToJson(value.numbers, NumberToJson)}};
}

json ToJson(const roster::CommandReply& value) {
  return {{"client_uid", value.client_uid},
          {"request_id", value.request_id},
          {"accepted", value.accepted},
          {"message", value.message}};
}

json ToJson(const ServiceHealth& value) {
  json values = json::object();
  for (const NamedValue& named : value.values) {
    values[named.name] = NumberToJson(named.value);
  }
  json latencies = json::object();
  for (const LatencyQuantiles& stage : value.latencies) {
    latencies[stage.stage] = {{"count", stage.count},
                              {"p50_us", NumberToJson(stage.p50_us)},
                              {"p99_us", NumberToJson(stage.p99_us)},
                              {"max_us", NumberToJson(stage.max_us)}};
  }
  return {{"process_uid", value.process_uid},
          {"role", value.role},
          {"host", value.host},
          {"pid", value.pid},
          {"started_at", TimeToJson(value.started_at)},
          {"reported_at", TimeToJson(value.reported_at)},
          {"cpu_seconds", NumberToJson(value.cpu_seconds)},
          {"rss_mib", NumberToJson(value.rss_mib)},
          {"values", std::move(values)},
          {"latencies", std::move(latencies)},
          {"last_error", value.last_error}};
}

}  // namespace limbcast::tool
