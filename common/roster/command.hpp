#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/base/ids.hpp"

namespace limbcast::roster {

/// What a client may ask of a service. Numbers are part of the wire contract: append only.
enum class CommandKind : std::uint8_t {
  kReferencePose =
      0,  ///< posture: the person stands in the reference pose now; set every offset (Eq. 33–36)
  kResetHeading = 1,   ///< posture: the way the body faces now is +x
  kSetDimensions = 2,  ///< posture: `text` names what, `numbers` are metres
  kSelectFilter = 3,   ///< fusion: `text` is the filter, `numbers` the segments (none = all)
  kUndo = 4,           ///< posture: take the last alignment back
  kFunctionalCalibration = 5,  ///< posture: `text` "start" (walk now), "finish" or "cancel"
  kResetMounting = 6,  ///< posture: the person stands in the reference pose; `text` is a segment
  kProfile = 7,        ///< posture: `text` "save NAME" or "load NAME"
  kCreateSession = 8,  ///< session host, where sessions are listed: `text` is the new one's name
  kCloseSession = 9,   ///< session host, in the session, from an operator of it: everybody leaves
  kLeaveSession =
      10,  ///< session host, in the session: `text` is the person, "" = all of the client
  kReleasePerson = 11,  ///< session host, in the session, from an operator: `text` is sent away
  kCountSessions =
      12,  ///< session host, where sessions are listed: the answer says how many, as a number
};

/// A request to a service (command topic, key client_uid).
struct Command {
  std::uint64_t client_uid = 0;  ///< random for each client process
  std::uint64_t request_id = 0;  ///< counts this client's requests
  BodyId body_id;
  CommandKind kind = CommandKind::kReferencePose;
  std::string text;             ///< at most 64 characters
  std::vector<double> numbers;  ///< at most 64
};

/// The answer to a Command (command topic, key client_uid).
struct CommandReply {
  std::uint64_t client_uid = 0;
  std::uint64_t request_id = 0;
  bool accepted = false;
  std::string message;  ///< what was done, or why not; at most 255 characters
};

}  // namespace limbcast::roster
