#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "common/body/body_definition.hpp"
#include "common/body/skeleton.hpp"
#include "common/client/client_options.hpp"
#include "common/client/skeleton_history.hpp"
#include "common/roster/command.hpp"
#include "common/roster/roster.hpp"

namespace limbcast::client {

/// Where a client stands with its session.
struct SessionStanding {
  bool member = true;
  BodyId body_id;       ///< of a performer, from the first acceptance on
  std::string message;  ///< why not a member
  bool operator==(const SessionStanding&) const = default;
};

/// A window onto all people of a session, for programs that draw or use them. Bodies appear and
/// vanish by themselves, services may restart; nothing has to be called for that. With
/// `options.session` it takes part in a session: it is asked for until the host answers, kept
/// alive, asked for again when the host was restarted, and left by the destructor. Thread-safe.
///
///   auto client = Client::Connect({});
///   for (BodyId body : (*client)->Bodies())
///     if (auto pose = (*client)->PoseAt(body, display_time)) Draw(*pose);
class Client {
 public:
  /// Fails with kInvalidArgument (an option), kUnavailable (the network or the session host
  /// refuses, with its reason) or kTimeout (no session host answers).
  [[nodiscard]] static Result<std::unique_ptr<Client>> Connect(const ClientOptions& options = {});

  /// The same on a bus that is there already (tests, all-in-one programs). `bus` and `clock`
  /// outlive the client. In a session, `bus` is in its partition. Takes from `options` all that is
  /// not about the network.
  [[nodiscard]] static Result<std::unique_ptr<Client>> Attach(bus::Bus& bus, const Clock& clock,
                                                              const ClientOptions& options = {});

  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// The time scale of every `measured_at` and of PoseAt: the system's clock, Unix epoch.
  [[nodiscard]] Time Now() const;

  /// People that are there: defined, and neither disposed of nor out of the roster. Ascending.
  [[nodiscard]] std::vector<BodyId> Bodies() const;

  /// Names, dimensions and sensors of a person; nothing for an unknown one.
  [[nodiscard]] std::optional<body::BodyDefinition> Definition(BodyId body_id) const;

  /// Name, sensors and coil slot of a person as the session host (or the gateway) has them.
  [[nodiscard]] std::optional<roster::RosterEntry> Entry(BodyId body_id) const;

  /// Where we stand in the session of the options; without one, kMember of none.
  [[nodiscard]] SessionStanding Standing() const;

  /// Called when Standing changes. As OnSkeleton.
  void OnStanding(std::function<void(const SessionStanding& standing)> callback);

  /// The newest skeleton; nothing before the first.
  [[nodiscard]] std::optional<body::Skeleton> Latest(BodyId body_id) const;

  /// The person at `display_time`, interpolated or predicted (see SkeletonHistory::At, Pose::age).
  [[nodiscard]] std::optional<Pose> PoseAt(BodyId body_id, Time display_time) const;

  /// Called for every skeleton, on a thread of the middleware: copy what is kept and return soon.
  /// An empty one ends the calls: none runs any more when this returns. Must not be called from a
  /// callback.
  void OnSkeleton(std::function<void(const body::Skeleton& skeleton)> callback);

  /// Called when a person appears, changes (present = true) or leaves. As OnSkeleton.
  void OnBody(std::function<void(const body::BodyDefinition& body, bool present)> callback);

  /// Asks the services for something (roster::CommandKind says what `text` and `numbers` mean) and
  /// waits for the answer: a CommandReply, which may be a refusal with its reason. Fails with
  /// kNotFound (no such body within the time), kUnavailable (nobody listens to commands) or
  /// kTimeout (no answer). Must not be called from a callback.
  [[nodiscard]] Result<roster::CommandReply> Send(roster::CommandKind kind, BodyId body_id,
                                                  const std::string& text = "",
                                                  const std::vector<double>& numbers = {},
                                                  Duration timeout = std::chrono::seconds(2));

  /// For operators: sends a person away, or ends the session for everybody. Fails with
  /// kInvalidArgument (the host refuses, with its reason), kUnavailable or kTimeout.
  [[nodiscard]] Status ReleasePerson(const std::string& person,
                                     Duration timeout = std::chrono::seconds(2));
  [[nodiscard]] Status CloseSession(Duration timeout = std::chrono::seconds(2));

  /// One line for a log: library, domain, partition, interfaces.
  [[nodiscard]] std::string Describe() const;

 private:
  class Impl;
  explicit Client(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace limbcast::client
