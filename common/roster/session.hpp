#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "common/base/ids.hpp"
#include "common/base/time.hpp"
#include "common/roster/roster.hpp"

namespace limbcast::roster {

/// What a participant of a session may do. Numbers are part of the wire contract.
enum class Role : std::uint8_t { kPerformer = 0, kSpectator = 1, kOperator = 2 };

/// One running session (state topic, key session_id).
struct SessionState {
  std::uint32_t session_id = 0;
  std::uint32_t revision = 0;
  std::string name;       ///< at most 64 characters
  std::string partition;  ///< DDS partition that carries its data; at most 64 characters
  bool open = true;
  std::uint32_t performer_count = 0;
  Time created_at{};
};

/// How often a client repeats its accepted JoinRequest, which is how the session host knows that it
/// is alive (a process that hangs repeats nothing). The host's patience is a few times as long.
inline constexpr Duration kRenewPeriod = std::chrono::milliseconds(200);

/// A request to take part (command topic, key client_uid). Repeated as it is while it is to last;
/// until an answer comes, each repetition has a new request_id.
struct JoinRequest {
  std::uint64_t client_uid = 0;
  std::uint64_t request_id = 0;
  std::string session;  ///< at most 64 characters
  std::string person;   ///< who wears the sensors, or who watches; at most 64 characters
  Role role = Role::kSpectator;
  /// What a performer wears; none = as when this person was here last. At most 64.
  std::vector<SensorAssignment> sensors;
  bool wants_coil_slot = false;  ///< a performer's, who wears a source of coils
};

/// The answer to a JoinRequest (command topic, key client_uid). A repeated request that changes
/// nothing is not answered.
struct JoinReply {
  std::uint64_t client_uid = 0;
  std::uint64_t request_id = 0;
  bool accepted = false;
  BodyId body_id;         ///< granted to a performer
  std::string partition;  ///< at most 64 characters
  std::string message;    ///< why not; at most 255 characters
};

}  // namespace limbcast::roster
