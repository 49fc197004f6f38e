#include "services/session/session_service.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "common/base/expects.hpp"

namespace limbcast::session {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kQueue = 4096;
constexpr Duration kTryAgain = 1s;   // a disk that is full, a partition that cannot be joined
constexpr Duration kLastWords = 2s;  // a closed session's room stays, so that all hear of it
constexpr int kTicksPerLease = 8;

template <typename... Fs>
struct Overloaded : Fs... {
  using Fs::operator()...;
};
template <typename... Fs>
Overloaded(Fs...) -> Overloaded<Fs...>;

}  // namespace

SessionService::SessionService(SessionConfig config, const Clock& clock, bus::Bus& lobby,
                               OpenPartition open_partition, runtime::WorkerPool& pool)
    : config_(std::move(config)),
      clock_(clock),
      lobby_(lobby),
      open_partition_(std::move(open_partition)),
      pool_(pool),
      queue_(kQueue),
      store_(config_.state_dir),
      registry_(config_.limits),
      refusals_left_(static_cast<double>(config_.max_refusals_per_s)) {
  Expects(Validate(config_).ok(), "a valid SessionConfig");
}

Status SessionService::Start() {
  Expects(!started_, "a service is started once");
  if (Status prepared = store_.Prepare(); !prepared) {
    return prepared;
  }
  const Time now = clock_.Now();
  Load(now);
  for (const std::string& name : config_.sessions) {
    if (const auto created = registry_.Create(name, now); created) {
      spdlog::info("session \"{}\" from the configuration", name);
    }
  }
  if (Status made = MakeLobby(); !made) {
    return made;
  }
  started_ = true;
  pool_.Start([this](std::size_t worker) { return worker == 0 ? Drain() : std::nullopt; });
  return Ok();
}

void SessionService::Load(Time now) {
  const auto loaded = store_.Load();
  std::string error = loaded ? loaded->warning : loaded.error().message;
  if (loaded) {
    if (auto restored = SessionRegistry::Restore(config_.limits, loaded->snapshot, now)) {
      registry_ = std::move(*restored);
    } else {
      store_.Refuse();
      error = store_.path().string() + ": " + restored.error().message;
    }
  }
  if (!error.empty()) {
    spdlog::error("{}", error);
    load_error_ = error;
  }
}

Status SessionService::MakeLobby() {
  auto states = lobby_.MakeWriter<roster::SessionState>();
  if (!states) {
    return states.error();
  }
  auto replies = lobby_.MakeWriter<roster::CommandReply>();
  if (!replies) {
    return replies.error();
  }
  auto hosts = lobby_.MakeReader<roster::SessionState>(
      {.on_sample = [](const roster::SessionState&, const bus::SampleInfo&) {}, .on_disposed = {}});
  if (!hosts) {
    return hosts.error();
  }
  auto commands = lobby_.MakeReader<roster::Command>(
      {.on_sample =
           [this](const roster::Command& command, const bus::SampleInfo&) {
             if (IsForSession(command.kind)) {
               Enqueue({"", command});
             }
           },
       .on_disposed = {}});
  if (!commands) {
    return commands.error();
  }
  states_ = std::move(*states);
  command_replies_ = std::move(*replies);
  hosts_ = std::move(*hosts);
  commands_ = std::move(*commands);
  return Ok();
}

void SessionService::Stop() {
  commands_.reset();
  if (started_) {
    pool_.Stop();
  }
  rooms_.clear();  // their readers first, so that nobody enqueues any more
  hosts_.reset();
}

void SessionService::Enqueue(Request request) {
  received_.fetch_add(1, std::memory_order_relaxed);
  if (!queue_.TryPush(std::move(request))) {
    dropped_.fetch_add(1, std::memory_order_relaxed);
  }
  pool_.Wake(0);
}

std::optional<Time> SessionService::Drain() {
  const Time now = clock_.Now();
  Request request;
  for (std::size_t i = 0; i < kQueue && queue_.TryPop(request); ++i) {
    Handle(request, now);
  }
  registry_.Expire(now);
  Save(now);
  Publish(now);
  SendReplies();
  LeaveRooms(now);
  now_.registry = registry_.counters();
  now_.sessions = registry_.session_count();
  now_.performers = registry_.performer_count();
  now_.watchers = registry_.watcher_count();
  now_.remembered = registry_.remembered_count();
  {
    const std::scoped_lock lock(mutex_);
    figures_ = now_;
  }
  return now + config_.limits.lease / kTicksPerLease;
}

void SessionService::Handle(const Request& request, Time now) {
  if (const auto* join = std::get_if<roster::JoinRequest>(&request.what)) {
    SessionRegistry::Answer answer = registry_.Join(request.session, *join, now);
    if (answer.is_news) {
      const bool accepted = answer.reply.accepted;
      Answer({request.session, std::move(answer.reply)}, accepted, now);
    }
    return;
  }
  const auto& command = std::get<roster::Command>(request.what);
  if (const roster::CommandReply* before = answered_.Find(command)) {
    Answer({request.session, *before}, before->accepted, now);
    return;
  }
  roster::CommandReply reply;
  reply.client_uid = command.client_uid;
  reply.request_id = command.request_id;
  std::string message = "done";
  Status done = Ok();
  if (command.kind == roster::CommandKind::kCountSessions) {
    message = std::to_string(registry_.session_count());
  } else if (command.kind != roster::CommandKind::kCreateSession) {
    done = registry_.Do(request.session, command, now);
  } else if (!config_.allow_create) {
    done = Error{ErrorCode::kUnavailable, "this host takes no new sessions (session.allow_create)"};
  } else if (const auto created = registry_.Create(command.text, now); !created) {
    done = created.error();
  }
  reply.accepted = done.ok();
  reply.message = done ? message : done.error().message;
  answered_.Add(reply);
  Answer({request.session, std::move(reply)}, done.ok(), now);
}

// Whoever asks without end for what cannot be is answered so often and no more: everybody in the
// session hears every answer.
void SessionService::Answer(Reply reply, bool accepted, Time now) {
  if (!accepted) {
    const auto rate = static_cast<double>(config_.max_refusals_per_s);
    const double passed_s = std::max(0.0, ToSeconds(now - std::exchange(refusals_at_, now)));
    refusals_left_ = std::min(rate, refusals_left_ + passed_s * rate);
    if (refusals_left_ < 1.0) {
      ++now_.refusals_unanswered;
      return;
    }
    refusals_left_ -= 1.0;
  }
  replies_.push_back(std::move(reply));
}

void SessionService::Save(Time now) {
  unsaved_ = registry_.TakeDirty() || unsaved_;
  if (!unsaved_ || now < save_again_at_) {
    return;
  }
  if (const Status saved = store_.Save(registry_.Snapshot()); !saved) {
    ++now_.save_errors;
    if (now_.disk_error.empty()) {
      spdlog::error("sessions are not saved: {}", saved.error().message);
    }
    now_.disk_error = saved.error().message;
    save_again_at_ = now + kTryAgain;
    return;
  }
  unsaved_ = false;
  ++now_.saves;
  save_again_at_ = {};
  now_.disk_error.clear();
}

void SessionService::Publish(Time now) {
  for (const Change& change : registry_.TakeChanges()) {
    std::visit(Overloaded{[&](const SessionOpened& opened) {
                            Send(*states_, opened.state);
                            Room& room = rooms_[opened.state.name];
                            room.leave_at.reset();
                            room.told = false;
                            open_again_at_ = {};
                          },
                          [&](const SessionChanged& changed) {
                            Send(*states_, changed.state);
                            if (SessionRoom* room = RoomOf(changed.state.name)) {
                              Send(room->states(), changed.state);
                            }
                          },
                          [&](const EntryChanged& changed) {
                            if (SessionRoom* room = RoomOf(changed.entry.session)) {
                              Send(room->entries(), changed.entry);
                            }
                          },
                          [&](const EntryGone& gone) {
                            if (SessionRoom* room = RoomOf(gone.entry.session)) {
                              Withdraw(room->entries(), gone.entry);
                            }
                          },
                          [&](const SessionClosed& closed) {
                            Withdraw(*states_, closed.state);
                            if (SessionRoom* room = RoomOf(closed.state.name)) {
                              Withdraw(room->states(), closed.state);
                            }
                            rooms_[closed.state.name].leave_at = now + kLastWords;
                          }},
               change);
  }
  OpenRooms(now);
  states_->Flush();
  for (auto& [name, room] : rooms_) {
    if (room.room != nullptr) {
      room.room->entries().Flush();
      room.room->states().Flush();
    }
  }
}

// Tells whoever is in a session, or comes later, all that is known of it.
void SessionService::OpenRooms(Time now) {
  if (now < open_again_at_) {
    return;
  }
  now_.room_error.clear();
  for (auto& [name, room] : rooms_) {
    if (room.leave_at || room.told) {
      continue;
    }
    if (room.room == nullptr) {
      auto bus = open_partition_(name);
      auto made =
          bus ? SessionRoom::Make(std::move(*bus),
                                  {.on_join =
                                       [this, session = name](const roster::JoinRequest& request) {
                                         Enqueue({session, request});
                                       },
                                   .on_command =
                                       [this, session = name](const roster::Command& command) {
                                         Enqueue({session, command});
                                       }})
              : Result<std::unique_ptr<SessionRoom>>(bus.error());
      if (!made) {
        now_.room_error = "session \"" + name + "\": " + made.error().message;
        spdlog::error("{}", now_.room_error);
        continue;
      }
      room.room = std::move(*made);
    }
    const std::optional<SessionContents> contents = registry_.Contents(name);
    Expects(contents.has_value(), "a room of a session that is open");
    Send(room.room->states(), contents->state);
    for (const roster::RosterEntry& entry : contents->entries) {
      Send(room.room->entries(), entry);
    }
    room.told = true;
  }
  open_again_at_ = now_.room_error.empty() ? Time::max() : now + kTryAgain;
}

void SessionService::SendReplies() {
  for (const Reply& reply : replies_) {
    SessionRoom* const room = RoomOf(reply.session);
    if (const auto* join = std::get_if<roster::JoinReply>(&reply.what)) {
      if (room != nullptr) {
        Send(room->join_replies(), *join);
        room->join_replies().Flush();
      }
      continue;
    }
    const auto& command = std::get<roster::CommandReply>(reply.what);
    if (reply.session.empty()) {
      Send(*command_replies_, command);
      command_replies_->Flush();
    } else if (room != nullptr) {
      Send(room->command_replies(), command);
      room->command_replies().Flush();
    }
  }
  replies_.clear();
}

void SessionService::LeaveRooms(Time now) {
  std::erase_if(rooms_, [&](const auto& entry) {
    const std::optional<Time>& leave_at = entry.second.leave_at;
    return leave_at && now >= *leave_at;
  });
}

SessionRoom* SessionService::RoomOf(const std::string& session) {
  const auto room = rooms_.find(session);
  return room == rooms_.end() ? nullptr : room->second.room.get();
}

template <typename T>
void SessionService::Send(bus::Writer<T>& writer, const T& value) {
  now_.write_errors += writer.Write(value) ? 0U : 1U;
}

template <typename T>
void SessionService::Withdraw(bus::Writer<T>& writer, const T& key) {
  now_.write_errors += writer.Dispose(key) ? 0U : 1U;
}

void SessionService::FillHealth(ServiceHealth& health) {
  Figures figures;
  std::string error;
  {
    const std::scoped_lock lock(mutex_);
    figures = figures_;
    error = load_error_;
  }
  const auto add = [&](const std::string& name, auto value) {
    health.values.push_back({name, static_cast<double>(value)});
  };
  add("requests.received", received_.load(std::memory_order_relaxed));
  add("requests.dropped", dropped_.load(std::memory_order_relaxed));
  add("members.joined", figures.registry.joined);
  add("members.renewed", figures.registry.renewed);
  add("members.left", figures.registry.left);
  add("members.vanished", figures.registry.vanished);
  add("members.released", figures.registry.released);
  for (std::size_t i = 0; i < kRefusalCount; ++i) {
    add("refused." + std::string(ToString(static_cast<Refusal>(i))), figures.registry.refused[i]);
  }
  add("refused.unanswered", figures.refusals_unanswered);
  add("saves", figures.saves);
  add("save_errors", figures.save_errors);
  add("write_errors", figures.write_errors);
  add("gauge.sessions", figures.sessions);
  add("gauge.performers", figures.performers);
  add("gauge.watchers", figures.watchers);
  add("gauge.remembered", figures.remembered);
  const std::int32_t others = hosts_ == nullptr ? 0 : hosts_->counters().matched - 1;
  add("gauge.other_hosts", std::max(others, 0));
  if (others > 0) {
    error = "another session host serves this network: who joins gets two answers";
  } else if (!figures.disk_error.empty()) {
    error = "not saved: " + figures.disk_error;
  } else if (!figures.room_error.empty()) {
    error = figures.room_error;
  }
  if (health.last_error.empty()) {
    health.last_error = error;
  }
}

}  // namespace limbcast::session
