#pragma once

#include <functional>
#include <memory>
#include <string>

#include "common/base/result.hpp"
#include "common/bus/bus.hpp"

namespace limbcast::session {

/// The host's place in the partition of one session: what it says there and what it hears.
/// Thread-compatible; the two handlers run on threads of the middleware and must only enqueue.
class SessionRoom {
 public:
  struct Handlers {
    std::function<void(const roster::JoinRequest& request)> on_join;
    std::function<void(const roster::Command& command)> on_command;
  };
  /// Takes over `bus`, which is in the session's partition.
  [[nodiscard]] static Result<std::unique_ptr<SessionRoom>> Make(std::unique_ptr<bus::Bus> bus,
                                                                 Handlers handlers);

  [[nodiscard]] bus::Writer<roster::RosterEntry>& entries() { return *entries_; }
  [[nodiscard]] bus::Writer<roster::SessionState>& states() { return *states_; }
  [[nodiscard]] bus::Writer<roster::JoinReply>& join_replies() { return *join_replies_; }
  [[nodiscard]] bus::Writer<roster::CommandReply>& command_replies() { return *command_replies_; }

 private:
  explicit SessionRoom(std::unique_ptr<bus::Bus> bus) : bus_(std::move(bus)) {}

  const std::unique_ptr<bus::Bus> bus_;
  std::unique_ptr<bus::Writer<roster::RosterEntry>> entries_;
  std::unique_ptr<bus::Writer<roster::SessionState>> states_;
  std::unique_ptr<bus::Writer<roster::JoinReply>> join_replies_;
  std::unique_ptr<bus::Writer<roster::CommandReply>> command_replies_;
  std::unique_ptr<bus::Reader<roster::JoinRequest>> join_requests_;
  std::unique_ptr<bus::Reader<roster::Command>> commands_;
};

/// Whether a command is for the session host.
[[nodiscard]] bool IsForSession(roster::CommandKind kind);

}  // namespace limbcast::session
