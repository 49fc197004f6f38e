#pragma once

#include <nlohmann/json.hpp>

#include "common/bus/topics.hpp"

namespace limbcast::tool {

/// What travels on a topic as JSON, with the names of the C++ fields: SI units, quaternions as
/// [w, x, y, z], times as int64 nanoseconds since the Unix epoch, enums by name. One overload for
/// each type of bus::AllTopics.
[[nodiscard]] nlohmann::json ToJson(const sensing::MargSample& value);
[[nodiscard]] nlohmann::json ToJson(const sensing::MargFrame& value);
[[nodiscard]] nlohmann::json ToJson(const sensing::FusedOrientation& value);
[[nodiscard]] nlohmann::json ToJson(const sensing::CoilBurst& value);
[[nodiscard]] nlohmann::json ToJson(const sensing::MarkerPosition& value);
[[nodiscard]] nlohmann::json ToJson(const sensing::PositionFix& value);
[[nodiscard]] nlohmann::json ToJson(const sensing::SensorInfo& value);
[[nodiscard]] nlohmann::json ToJson(const body::SegmentState& value);
[[nodiscard]] nlohmann::json ToJson(const body::SegmentFrame& value);
[[nodiscard]] nlohmann::json ToJson(const body::SegmentTruth& value);
[[nodiscard]] nlohmann::json ToJson(const body::BodyDefinition& value);
[[nodiscard]] nlohmann::json ToJson(const body::Skeleton& value);
[[nodiscard]] nlohmann::json ToJson(const body::JointAngleFrame& value);
[[nodiscard]] nlohmann::json ToJson(const roster::RosterEntry& value);
[[nodiscard]] nlohmann::json ToJson(const roster::SessionState& value);
[[nodiscard]] nlohmann::json ToJson(const roster::JoinRequest& value);
[[nodiscard]] nlohmann::json ToJson(const roster::JoinReply& value);
[[nodiscard]] nlohmann::json ToJson(const roster::Command& value);
[[nodiscard]] nlohmann::json ToJson(const roster::CommandReply& value);
[[nodiscard]] nlohmann::json ToJson(const ServiceHealth& value);

/// Only the key fields.
template <typename T>
[[nodiscard]] nlohmann::json KeyToJson(const T& key) {
  nlohmann::json result;
  if constexpr (
      requires { key.sensor_uid; } && !requires { key.body_id; }) {
    result["sensor_uid"] = key.sensor_uid.value;
  }
  if constexpr (
      requires { key.body_id; } && !requires { key.request_id; }) {
    result["body_id"] = key.body_id.value;
  }
  if constexpr (
      requires { key.segment; } && requires { key.body_id; }) {
    result["segment"] = body::ToString(key.segment);
  }
  if constexpr (requires { key.client_uid; }) {
    result["client_uid"] = key.client_uid;
  }
  if constexpr (requires { key.process_uid; }) {
    result["process_uid"] = key.process_uid;
  }
  if constexpr (requires { key.session_id; }) {
    result["session_id"] = key.session_id;
  }
  return result;
}

}  // namespace limbcast::tool
