#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/health.hpp"
#include "common/base/result.hpp"
#include "common/bus/bus.hpp"
#include "common/roster/answered_commands.hpp"
#include "common/runtime/bounded_queue.hpp"
#include "common/runtime/worker_pool.hpp"
#include "services/session/session_config.hpp"
#include "services/session/session_registry.hpp"
#include "services/session/session_room.hpp"
#include "services/session/session_store.hpp"

namespace limbcast::session {

/// Serves sessions. The lobby, a partition of its own, tells which sessions there are and takes
/// kCreateSession and kCountSessions; everything else is asked in the partition of the session
/// itself, which carries its roster too. Reader callbacks only enqueue (what does not fit is
/// counted); all work is done in the first worker of the pool. What is answered or published has
/// been written to the disk before; when the disk refuses, that is said in health and tried again,
/// and sessions go on.
class SessionService {
 public:
  /// Joins the partition of a session. Called on the worker.
  using OpenPartition =
      std::function<Result<std::unique_ptr<bus::Bus>>(const std::string& partition)>;

  /// `config` is valid. `clock`, `lobby` and `pool` (not started, at least one worker) outlive it.
  SessionService(SessionConfig config, const Clock& clock, bus::Bus& lobby,
                 OpenPartition open_partition, runtime::WorkerPool& pool);
  ~SessionService() { Stop(); }
  SessionService(const SessionService&) = delete;
  SessionService& operator=(const SessionService&) = delete;

  /// Takes up what was saved, joins the topics and starts. Called once. Fails when the bus or the
  /// state folder refuses; a broken file is set aside and said in health.
  [[nodiscard]] Status Start();

  /// Leaves the network; the roster stays with those who have it. Idempotent.
  void Stop();

  /// Thread-safe, for one caller.
  void FillHealth(ServiceHealth& health);

 private:
  struct Request {
    std::string session;  // "" = lobby
    std::variant<roster::JoinRequest, roster::Command> what;
  };
  struct Reply {
    std::string session;
    std::variant<roster::JoinReply, roster::CommandReply> what;
  };
  struct Room {
    std::unique_ptr<SessionRoom> room;
    bool told = false;             // all that is known of the session
    std::optional<Time> leave_at;  // closed: stays until what was said last has arrived
  };
  struct Figures {
    RegistryCounters registry;
    std::size_t sessions = 0;
    std::size_t performers = 0;
    std::size_t watchers = 0;
    std::size_t remembered = 0;
    std::uint64_t saves = 0;
    std::uint64_t save_errors = 0;
    std::uint64_t write_errors = 0;
    std::uint64_t refusals_unanswered = 0;
    std::string disk_error;
    std::string room_error;
  };

  [[nodiscard]] Status MakeLobby();
  void Load(Time now);
  void Enqueue(Request request);
  std::optional<Time> Drain();
  void Handle(const Request& request, Time now);
  void Answer(Reply reply, bool accepted, Time now);
  void Save(Time now);
  void Publish(Time now);
  void SendReplies();
  void OpenRooms(Time now);
  void LeaveRooms(Time now);
  [[nodiscard]] SessionRoom* RoomOf(const std::string& session);
  template <typename T>
  void Send(bus::Writer<T>& writer, const T& value);
  template <typename T>
  void Withdraw(bus::Writer<T>& writer, const T& key);

  const SessionConfig config_;
  const Clock& clock_;
  bus::Bus& lobby_;
  const OpenPartition open_partition_;
  runtime::WorkerPool& pool_;
  bool started_ = false;
  runtime::BoundedQueue<Request> queue_;
  std::atomic<std::uint64_t> received_{0};
  std::atomic<std::uint64_t> dropped_{0};

  // Of the worker alone, once started.
  SessionStore store_;
  SessionRegistry registry_;
  std::map<std::string, Room> rooms_;
  std::vector<Reply> replies_;
  roster::AnsweredCommands answered_;
  double refusals_left_;
  Time refusals_at_{};
  bool unsaved_ = false;
  Time save_again_at_{};
  Time open_again_at_{};
  Figures now_;

  mutable std::mutex mutex_;  // guards the next two
  Figures figures_;           // of the last drain
  std::string load_error_;

  std::unique_ptr<bus::Writer<roster::SessionState>> states_;
  std::unique_ptr<bus::Writer<roster::CommandReply>> command_replies_;
  std::unique_ptr<bus::Reader<roster::Command>> commands_;
  std::unique_ptr<bus::Reader<roster::SessionState>> hosts_;  // to notice another host
};

}  // namespace limbcast::session
