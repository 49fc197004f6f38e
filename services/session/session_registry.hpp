#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <variant>
#include <vector>

#include "common/base/result.hpp"
#include "common/base/time.hpp"
#include "common/roster/command.hpp"
#include "common/roster/session.hpp"
#include "services/session/session_snapshot.hpp"

namespace limbcast::session {

/// What one host takes on. Nothing that clients send lets it grow beyond these.
struct RegistryLimits {
  std::size_t max_sessions = 16;             ///< range: [1, 100]
  std::size_t max_members = 1024;            ///< of one session, all roles. Range: [1, 4096]
  std::size_t max_members_of_client = 256;   ///< in one session. Range: [1, 4096]
  std::size_t max_remembered = 4096;         ///< people of all sessions who left. Range: [0, 65536]
  Duration lease = std::chrono::seconds(2);  ///< a client silent for longer has vanished: [1, 60] s
  Duration grace = std::chrono::seconds(30);  ///< a person who vanished stays so long: [0, 1 d]
  double new_members_per_s = 200.0;       ///< all sessions; a burst may have twice that: [1, 1e5]
  std::uint32_t coil_slots = 1;           ///< sources that can pulse in turn. Range: [0, 1000]
  std::uint32_t coil_frame_us = 200'000;  ///< in which each of them does. Range: [1000, 1e9]
};
[[nodiscard]] Status Validate(const RegistryLimits& limits);

/// Why a request was refused.
enum class Refusal : std::uint8_t {
  kBadName,       ///< of a session or person
  kWrongSession,  ///< no such session, or another than the one it was asked in
  kExists,        ///< a session of that name
  kPersonTaken,   ///< another client that is alive carries this person
  kSensorTaken,   ///< somebody else who is alive wears it
  kBadSensors,    ///< none, twice the same, or two on a segment
  kFull,          ///< a limit on sessions or members
  kTooFast,       ///< more new members in a second than allowed
  kNotMember,     ///< leaves without having joined
  kNotOperator,   ///< asks for what operators may do
};
inline constexpr std::size_t kRefusalCount = 10;
/// "bad_name", "person_taken", ...
[[nodiscard]] std::string_view ToString(Refusal refusal);

/// What the rest of the world has to be told, in order.
struct SessionOpened {
  roster::SessionState state;
};
struct SessionChanged {
  roster::SessionState state;
};
struct SessionClosed {
  roster::SessionState state;
};
struct EntryChanged {
  roster::RosterEntry entry;
};
struct EntryGone {
  roster::RosterEntry entry;
};
using Change = std::variant<SessionOpened, SessionChanged, SessionClosed, EntryChanged, EntryGone>;

/// All that the members of a session are told of it.
struct SessionContents {
  roster::SessionState state;
  std::vector<roster::RosterEntry> entries;
};

struct RegistryCounters {
  std::uint64_t joined = 0;    ///< new members, also those who returned
  std::uint64_t renewed = 0;   ///< repeated requests of members
  std::uint64_t left = 0;      ///< in good order
  std::uint64_t vanished = 0;  ///< clients that fell silent
  std::uint64_t released = 0;  ///< people who did not return within the grace time
  std::array<std::uint64_t, kRefusalCount> refused{};
};

/// Who takes part in which session: the rules of the session host. No DDS, no clock, no file: the
/// caller brings requests and the time, and carries what Changes() say to the network and
/// Snapshot() to the disk.
///
/// A person is known by session and name. Who joins as performer for the first time gets a body id
/// that no other person of any session ever had, and has it again whenever it returns. A person
/// whose client falls silent stays in the roster for the grace time, in which any client may carry
/// it on; then it is released: out of the roster, id remembered. A client that brings the very
/// sensors of the person is its old client started again, and need not wait for the lease but for
/// three missed renewals. Who is there is never pushed out, neither is a sensor taken from whoever
/// is alive. Thread-compatible.
class SessionRegistry {
 public:
  /// `limits` are valid.
  explicit SessionRegistry(const RegistryLimits& limits);

  /// The registry as it was; everybody who was there has a whole lease to speak up. Changes() tell
  /// of all of it. Fails with kCorruptData when `snapshot` contradicts itself or the limits.
  [[nodiscard]] static Result<SessionRegistry> Restore(const RegistryLimits& limits,
                                                       const SessionSnapshot& snapshot, Time now);

  [[nodiscard]] Result<roster::SessionState> Create(std::string_view name, Time now);

  /// An answer to a join request that came in the partition of `session`. `is_news` is false for a
  /// repeated request that changed nothing: it needs no answer.
  struct Answer {
    roster::JoinReply reply;
    bool is_news = true;
  };
  [[nodiscard]] Answer Join(std::string_view session, const roster::JoinRequest& request, Time now);

  /// What a client may ask in `session` beside joining it: kLeaveSession, kReleasePerson,
  /// kCloseSession.
  [[nodiscard]] Status Do(std::string_view session, const roster::Command& command, Time now);

  /// Notices who fell silent and releases who did not return. To be called several times in a
  /// lease: a longer pause means that the host itself was not there (stopped, or its clock set),
  /// and counts for nobody.
  void Expire(Time now);

  /// What happened since the last call.
  [[nodiscard]] std::vector<Change> TakeChanges();
  /// Whether Snapshot() differs from the one at the last call.
  [[nodiscard]] bool TakeDirty();

  [[nodiscard]] SessionSnapshot Snapshot() const;
  /// Nothing when there is no such session.
  [[nodiscard]] std::optional<SessionContents> Contents(std::string_view session) const;
  [[nodiscard]] const RegistryCounters& counters() const { return counters_; }
  [[nodiscard]] std::size_t session_count() const { return sessions_.size(); }
  [[nodiscard]] std::size_t performer_count() const { return performers_; }
  [[nodiscard]] std::size_t watcher_count() const { return watchers_; }
  [[nodiscard]] std::size_t remembered_count() const { return remembered_; }

 private:
  struct Person {
    KnownPerson known;
    bool alive = false;
    Time seen_at{};
    std::uint64_t answered_request = 0;
    bool wants_coil_slot = false;
  };
  struct Watcher {
    Time seen_at{};
    std::uint64_t answered_request = 0;
  };
  using WatcherKey = std::tuple<std::uint64_t, roster::Role, std::string>;  // client, role, name
  struct Session {
    KnownSession known;  // without people
    std::map<std::string, Person, std::less<>> people;
    std::map<WatcherKey, Watcher> watchers;
    std::map<std::uint64_t, std::size_t> members_of_client;
    std::size_t performers = 0;
    bool changed = false;
  };
  struct Wearer {
    std::string session;
    std::string person;
  };

  Error Refuse(Refusal refusal, ErrorCode code, std::string message);
  [[nodiscard]] Status JoinPerformer(Session& session, const roster::JoinRequest& request, Time now,
                                     Answer& answer);
  [[nodiscard]] static bool IsRestart(const Person& before, const roster::JoinRequest& request,
                                      Time now);
  [[nodiscard]] Status JoinWatcher(Session& session, const roster::JoinRequest& request, Time now,
                                   Answer& answer);
  [[nodiscard]] Status Leave(Session& session, const roster::Command& command, Time now);
  [[nodiscard]] Status CheckSensors(const std::vector<roster::SensorAssignment>& sensors);
  [[nodiscard]] Status CheckFree(const Session& session, std::string_view person,
                                 const std::vector<roster::SensorAssignment>& sensors);
  [[nodiscard]] Status TakePlace(Session& session, std::uint64_t client_uid, Time now);
  [[nodiscard]] Status CheckOperator(const Session& session, std::uint64_t client_uid);
  [[nodiscard]] Session* Find(std::string_view name);
  [[nodiscard]] roster::SessionState StateOf(const Session& session) const;
  [[nodiscard]] roster::RosterEntry EntryOf(const Session& session, const Person& person) const;
  [[nodiscard]] std::uint32_t FreeSlot(const Session& session, std::uint32_t preferred) const;
  void PassSlotOn(Session& session, const Person& from);
  void Enter(Session& session, Person& person, const roster::JoinRequest& request, Time now);
  void Wear(const Session& session, Person& person, std::vector<roster::SensorAssignment> sensors,
            Time now);
  void Unwear(const Session& session, const Person& person);
  void Release(Session& session, Person& person, Time now);
  void Close(Session& session);
  void ForgetOldest();
  void Changed(Session& session);
  static void Count(Session& session, std::uint64_t client_uid, int more);

  RegistryLimits limits_;
  std::uint32_t next_session_id_ = 1;
  std::uint32_t next_body_id_ = 1;
  std::map<std::string, Session, std::less<>> sessions_;
  std::unordered_map<SensorUid, Wearer> wearers_;  // of people who are here
  std::size_t performers_ = 0;
  std::size_t watchers_ = 0;
  std::size_t remembered_ = 0;
  double places_ = 0.0;  // new members that may come now
  Time places_at_{};
  std::optional<Time> expired_at_;
  std::vector<Change> changes_;
  bool dirty_ = false;
  RegistryCounters counters_;
};

}  // namespace limbcast::session
