#include "services/session/session_room.hpp"

#include <utility>

namespace limbcast::session {
namespace {

template <typename Made>
Status Take(Result<std::unique_ptr<Made>> made, std::unique_ptr<Made>& into) {
  if (!made) {
    return made.error();
  }
  into = std::move(*made);
  return Ok();
}

}  // namespace

bool IsForSession(roster::CommandKind kind) {
  using roster::CommandKind;
  return kind == CommandKind::kCreateSession || kind == CommandKind::kCloseSession ||
         kind == CommandKind::kLeaveSession || kind == CommandKind::kReleasePerson ||
         kind == CommandKind::kCountSessions;
}

Result<std::unique_ptr<SessionRoom>> SessionRoom::Make(std::unique_ptr<bus::Bus> bus,
                                                       Handlers handlers) {
  std::unique_ptr<SessionRoom> room(new SessionRoom(std::move(bus)));
  bus::Bus& in = *room->bus_;
  Status made = Take(in.MakeWriter<roster::RosterEntry>(), room->entries_);
  made = made ? Take(in.MakeWriter<roster::SessionState>(), room->states_) : made;
  made = made ? Take(in.MakeWriter<roster::JoinReply>(), room->join_replies_) : made;
  made = made ? Take(in.MakeWriter<roster::CommandReply>(), room->command_replies_) : made;
  // Whoever sees a reader may ask: the answers come first.
  made = made ? Take(in.MakeReader<roster::JoinRequest>(
                         {.on_sample = [on_join = std::move(handlers.on_join)](
                                           const roster::JoinRequest& request,
                                           const bus::SampleInfo&) { on_join(request); },
                          .on_disposed = {}}),
                     room->join_requests_)
              : made;
  made = made ? Take(in.MakeReader<roster::Command>(
                         {.on_sample =
                              [on_command = std::move(handlers.on_command)](
                                  const roster::Command& command, const bus::SampleInfo&) {
                                if (IsForSession(command.kind)) {
                                  on_command(command);
                                }
                              },
                          .on_disposed = {}}),
                     room->commands_)
              : made;
  if (!made) {
    return made.error();
  }
  return room;
}

}  // namespace limbcast::session
