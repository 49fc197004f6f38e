#include "common/client/session_member.hpp"

#include <algorithm>
#include <chrono>

namespace limbcast::client {
namespace {

constexpr std::uint32_t kTicksAfterRefusal = 3;
constexpr auto kGoodBye = std::chrono::milliseconds(300);

}  // namespace

SessionMember::SessionMember(std::string session, std::vector<Membership> as, OnChange on_change)
    : session_(std::move(session)), on_change_(std::move(on_change)) {
  for (Membership& membership : as) {
    members_.emplace_back().as = std::move(membership);
  }
}

Result<std::unique_ptr<SessionMember>> SessionMember::Make(bus::Bus& bus, std::string session,
                                                           std::vector<Membership> as,
                                                           OnChange on_change) {
  std::unique_ptr<SessionMember> member(
      new SessionMember(std::move(session), std::move(as), std::move(on_change)));
  auto commands = Requester<roster::Command, roster::CommandReply>::Make(bus, member->client_uid_);
  if (!commands) {
    return commands.error();
  }
  auto requests = bus.MakeWriter<roster::JoinRequest>();
  if (!requests) {
    return requests.error();
  }
  auto replies = bus.MakeReader<roster::JoinReply>(
      {.on_sample = [self = member.get()](const roster::JoinReply& reply,
                                          const bus::SampleInfo&) { self->Take(reply); },
       .on_disposed = {}});
  if (!replies) {
    return replies.error();
  }
  member->commands_ = std::move(*commands);
  member->requests_writer_ = std::move(*requests);
  member->replies_ = std::move(*replies);
  return member;
}

SessionMember::~SessionMember() { Leave(); }

void SessionMember::Start() {
  Tick();
  thread_.emplace("session-member", roster::kRenewPeriod, [this] { Tick(); });
}

void SessionMember::Tick() {
  std::vector<roster::JoinRequest> requests;
  {
    const std::scoped_lock lock(mutex_);
    for (Member& member : members_) {
      if (member.ticks_to_wait > 0) {
        --member.ticks_to_wait;
        continue;
      }
      if (member.status.state != MemberState::kMember) {
        member.request_id = ++requests_;  // the answer to the one before may have been lost
        member.ticks_to_wait =
            member.status.state == MemberState::kRefused ? kTicksAfterRefusal - 1 : 0;
      }
      requests.push_back({.client_uid = client_uid_,
                          .request_id = member.request_id,
                          .session = session_,
                          .person = member.as.person,
                          .role = member.as.role,
                          .sensors = member.as.sensors,
                          .wants_coil_slot = member.as.wants_coil_slot});
    }
  }
  for (const roster::JoinRequest& request : requests) {
    (void)requests_writer_->Write(request);  // repeated anyway
  }
  requests_writer_->Flush();
}

void SessionMember::Take(const roster::JoinReply& reply) {
  if (reply.client_uid != client_uid_) {
    return;  // somebody else's
  }
  std::unique_lock lock(mutex_);
  const auto member = std::find_if(members_.begin(), members_.end(), [&](const Member& m) {
    return m.request_id == reply.request_id;
  });
  if (member == members_.end()) {
    return;  // late: asked again since
  }
  MemberStatus status{.state = reply.accepted ? MemberState::kMember : MemberState::kRefused,
                      .body_id = reply.accepted ? reply.body_id : member->status.body_id,
                      .message = reply.accepted ? std::string() : reply.message};
  member->ticks_to_wait = reply.accepted ? 0 : kTicksAfterRefusal - 1;
  const bool tell = on_change_ && !(member->status == status);
  member->status = status;
  const auto index = static_cast<std::size_t>(member - members_.begin());
  if (tell) {
    telling_ = true;  // replies come one at a time
    lock.unlock();
    on_change_(index, status);
    lock.lock();
    telling_ = false;
  }
  changed_.notify_all();
}

Status SessionMember::WaitUntilJoined(Duration timeout) {
  std::unique_lock lock(mutex_);
  const auto in_state = [&](MemberState state) {
    return std::find_if(members_.begin(), members_.end(),
                        [&](const Member& m) { return m.status.state == state; });
  };
  const bool joined = changed_.wait_for(lock, timeout, [&] {
    return !telling_ && std::all_of(members_.begin(), members_.end(), [](const Member& m) {
      return m.status.state == MemberState::kMember;
    });
  });
  if (joined) {
    return Ok();
  }
  if (const auto refused = in_state(MemberState::kRefused); refused != members_.end()) {
    return Error{ErrorCode::kUnavailable, "session \"" + session_ + "\": \"" + refused->as.person +
                                              "\" refused: " + refused->status.message};
  }
  return Error{ErrorCode::kTimeout, "no session host answers for session \"" + session_ +
                                        "\" within " + std::to_string(ToSeconds(timeout)) + " s"};
}

MemberStatus SessionMember::status(std::size_t index) const {
  const std::scoped_lock lock(mutex_);
  return members_.at(index).status;
}

Result<roster::CommandReply> SessionMember::Ask(roster::CommandKind kind, const std::string& text,
                                                Duration timeout) {
  roster::Command command;
  command.kind = kind;
  command.text = text;
  return commands_->Ask(std::move(command), std::chrono::steady_clock::now() + timeout);
}

void SessionMember::Leave() {
  thread_.reset();
  {
    const std::scoped_lock lock(mutex_);
    const bool known = std::any_of(members_.begin(), members_.end(), [](const Member& m) {
      return m.status.state == MemberState::kMember;
    });
    if (std::exchange(left_, true) || !known) {
      return;
    }
  }
  if (requests_writer_->counters().matched > 0) {
    (void)Ask(roster::CommandKind::kLeaveSession, "", kGoodBye);
  }
}

}  // namespace limbcast::client
