#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/bus/bus.hpp"
#include "common/client/requester.hpp"
#include "common/runtime/periodic_thread.hpp"

namespace limbcast::client {

/// As what somebody is in a session.
struct Membership {
  roster::Role role = roster::Role::kSpectator;
  std::string person;                             ///< 1 to 64 bytes
  std::vector<roster::SensorAssignment> sensors;  ///< a performer's; none = as when last here
  bool wants_coil_slot = false;                   ///< a performer's, who wears a source of coils
};

enum class MemberState : std::uint8_t {
  kAsking,   ///< no answer yet
  kMember,   ///< accepted
  kRefused,  ///< not accepted, or no longer; asked again every two seconds
};

struct MemberStatus {
  MemberState state = MemberState::kAsking;
  BodyId body_id;       ///< a performer's, from the first acceptance on
  std::string message;  ///< of a refusal
  bool operator==(const MemberStatus&) const = default;
};

/// Takes part in a session: asks the session host for each membership until it is accepted, and
/// repeats the request while it lives, so that the host knows that this client is alive, and knows
/// it again when the host itself was restarted. For gateways (a membership for each person) and
/// clients (one). Thread-safe.
class SessionMember {
 public:
  /// Called with the number of the membership when its status changes; on a thread of the
  /// middleware, must not call back.
  using OnChange = std::function<void(std::size_t index, const MemberStatus& status)>;

  /// `bus` is in the partition of the session, which is its name, and outlives this.
  [[nodiscard]] static Result<std::unique_ptr<SessionMember>> Make(bus::Bus& bus,
                                                                   std::string session,
                                                                   std::vector<Membership> as,
                                                                   OnChange on_change = {});
  /// Leaves, see Leave.
  ~SessionMember();
  SessionMember(const SessionMember&) = delete;
  SessionMember& operator=(const SessionMember&) = delete;

  /// Starts the thread that asks and repeats. Tests call Tick instead.
  void Start();
  /// To be called every roster::kRenewPeriod.
  void Tick();

  /// Waits until all memberships are accepted and OnChange has been told so; a refusal may pass (a
  /// person is free two seconds after the client that carried it was killed), so it is waited for
  /// as well. Fails with kUnavailable (still refused, with the host's reason) or kTimeout (no host
  /// answers); asking goes on then.
  [[nodiscard]] Status WaitUntilJoined(Duration timeout);

  [[nodiscard]] MemberStatus status(std::size_t index) const;

  /// Asks the host for something that operators may do (kReleasePerson, kCloseSession).
  [[nodiscard]] Result<roster::CommandReply> Ask(roster::CommandKind kind, const std::string& text,
                                                 Duration timeout);

  /// Ends asking, and tells a host that is there. Waits for its answer, at most 0.3 s. Idempotent.
  void Leave();

 private:
  struct Member {
    Membership as;
    MemberStatus status;
    std::uint64_t request_id = 0;
    std::uint32_t ticks_to_wait = 0;
  };
  SessionMember(std::string session, std::vector<Membership> as, OnChange on_change);
  void Take(const roster::JoinReply& reply);

  const std::uint64_t client_uid_ = DrawClientUid();
  const std::string session_;
  const OnChange on_change_;
  mutable std::mutex mutex_;  // guards the next four
  bool telling_ = false;      // inside on_change_
  std::condition_variable changed_;
  std::vector<Member> members_;
  std::uint64_t requests_ = 0;
  bool left_ = false;
  std::unique_ptr<Requester<roster::Command, roster::CommandReply>> commands_;
  std::unique_ptr<bus::Writer<roster::JoinRequest>> requests_writer_;
  std::unique_ptr<bus::Reader<roster::JoinReply>> replies_;
  std::optional<runtime::PeriodicThread> thread_;
};

}  // namespace limbcast::client
