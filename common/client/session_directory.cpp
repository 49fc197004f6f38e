#include "common/client/session_directory.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

#include "common/client/network.hpp"
#include "common/client/requester.hpp"

namespace limbcast::client {

class SessionDirectory::Impl {
 public:
  void Own(std::unique_ptr<bus::Bus> bus) { own_bus_ = std::move(bus); }

  Status Join(bus::Bus& bus) {
    auto commands = Requester<roster::Command, roster::CommandReply>::Make(bus, DrawClientUid());
    if (!commands) {
      return commands.error();
    }
    auto states = bus.MakeReader<roster::SessionState>(
        {.on_sample =
             [this](const roster::SessionState& state, const bus::SampleInfo&) {
               const std::scoped_lock lock(mutex_);
               sessions_[state.session_id] = state;
               heard_.notify_all();
             },
         .on_disposed =
             [this](const roster::SessionState& key) {
               const std::scoped_lock lock(mutex_);
               sessions_.erase(key.session_id);
               heard_.notify_all();
             }});
    if (!states) {
      return states.error();
    }
    commands_ = std::move(*commands);
    states_ = std::move(*states);
    return Ok();
  }

  Status WaitForHost(Duration timeout) {
    const auto until = std::chrono::steady_clock::now() + timeout;
    // Matching wakes nobody, and is looked at until a session is told of or time is up.
    while (states_->counters().matched == 0 || !commands_->heard()) {
      if (std::chrono::steady_clock::now() >= until) {
        return Error{ErrorCode::kTimeout,
                     "no session host within " + std::to_string(ToSeconds(timeout)) +
                         " s (is limbcast-session running, in this domain and partition?)"};
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return Ok();
  }

  std::vector<roster::SessionState> Sessions() const {
    const std::scoped_lock lock(mutex_);
    std::map<std::string, roster::SessionState> by_name;
    for (const auto& [id, state] : sessions_) {
      by_name[state.name] = state;
    }
    std::vector<roster::SessionState> sessions;
    sessions.reserve(by_name.size());
    for (auto& [name, state] : by_name) {
      sessions.push_back(std::move(state));
    }
    return sessions;
  }

  Result<std::vector<roster::SessionState>> List(Duration timeout) {
    constexpr auto kAskAgain = std::chrono::milliseconds(200);  // one may open or close meanwhile
    const auto until = std::chrono::steady_clock::now() + timeout;
    if (Status host = WaitForHost(timeout); !host) {
      return host.error();
    }
    for (;;) {
      roster::Command command;
      command.kind = roster::CommandKind::kCountSessions;
      const auto reply = commands_->Ask(std::move(command), until);
      if (!reply) {
        return Error{reply.error().code, "list of sessions: " + reply.error().message};
      }
      const auto now = std::chrono::steady_clock::now();
      const std::size_t known = HearOf(reply->message, std::min(until, now + kAskAgain));
      if (std::to_string(known) == reply->message) {
        return Sessions();
      }
      if (std::chrono::steady_clock::now() >= until) {
        return Error{ErrorCode::kTimeout, "the session host says \"" + reply->message +
                                              "\" to how many sessions it has, and " +
                                              std::to_string(known) + " are known within " +
                                              std::to_string(ToSeconds(timeout)) + " s"};
      }
    }
  }

  Status Create(const std::string& name, Duration timeout) {
    if (Status host = WaitForHost(timeout); !host) {
      return host;
    }
    roster::Command command;
    command.kind = roster::CommandKind::kCreateSession;
    command.text = name;
    const auto reply =
        commands_->Ask(std::move(command), std::chrono::steady_clock::now() + timeout);
    if (!reply) {
      return Error{reply.error().code, "session \"" + name + "\": " + reply.error().message};
    }
    return reply->accepted ? Ok() : Error{ErrorCode::kInvalidArgument, reply->message};
  }

 private:
  // How many sessions are known: `count` of them, or those at `until`.
  std::size_t HearOf(const std::string& count, std::chrono::steady_clock::time_point until) {
    std::unique_lock lock(mutex_);
    heard_.wait_until(lock, until, [&] { return std::to_string(sessions_.size()) == count; });
    return sessions_.size();
  }

  mutable std::mutex mutex_;  // guards sessions_
  std::condition_variable heard_;
  std::map<std::uint32_t, roster::SessionState> sessions_;
  std::unique_ptr<bus::Bus> own_bus_;  // outlives the endpoints, which are declared after it
  std::unique_ptr<Requester<roster::Command, roster::CommandReply>> commands_;
  std::unique_ptr<bus::Reader<roster::SessionState>> states_;
};

SessionDirectory::SessionDirectory(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SessionDirectory::~SessionDirectory() = default;

Result<std::unique_ptr<SessionDirectory>> SessionDirectory::Connect(const ClientOptions& options) {
  auto bus = OpenNetwork(options);
  if (!bus) {
    return bus.error();
  }
  auto impl = std::make_unique<Impl>();
  bus::Bus& joined = **bus;
  impl->Own(std::move(*bus));
  if (const Status status = impl->Join(joined); !status) {
    return status.error();
  }
  return std::unique_ptr<SessionDirectory>(new SessionDirectory(std::move(impl)));
}

Result<std::unique_ptr<SessionDirectory>> SessionDirectory::Attach(bus::Bus& bus) {
  auto impl = std::make_unique<Impl>();
  if (const Status status = impl->Join(bus); !status) {
    return status.error();
  }
  return std::unique_ptr<SessionDirectory>(new SessionDirectory(std::move(impl)));
}

Status SessionDirectory::WaitForHost(Duration timeout) { return impl_->WaitForHost(timeout); }
std::vector<roster::SessionState> SessionDirectory::Sessions() const { return impl_->Sessions(); }
Result<std::vector<roster::SessionState>> SessionDirectory::List(Duration timeout) {
  return impl_->List(timeout);
}
Status SessionDirectory::Create(const std::string& name, Duration timeout) {
  return impl_->Create(name, timeout);
}

}  // namespace limbcast::client
