#pragma once

#include <cstdint>
#include <string>

#include "common/base/ids.hpp"
#include "common/base/time.hpp"

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

/// A request to take part (command topic, key client_uid).
struct JoinRequest {
  std::uint64_t client_uid = 0;
  std::uint64_t request_id = 0;
  std::string session;  ///< at most 64 characters
  std::string person;   ///< at most 64 characters
  Role role = Role::kSpectator;
};

/// The answer to a JoinRequest (command topic, key client_uid).
struct JoinReply {
  std::uint64_t client_uid = 0;
  std::uint64_t request_id = 0;
  bool accepted = false;
  BodyId body_id;         ///< granted to a performer
  std::string partition;  ///< at most 64 characters
  std::string message;    ///< why not; at most 255 characters
};

}  // namespace limbcast::roster
