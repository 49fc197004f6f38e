#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/client/client_options.hpp"
#include "common/roster/session.hpp"

namespace limbcast::client {

/// Which sessions there are on a network, and new ones. Thread-safe.
class SessionDirectory {
 public:
  /// Joins the network in `options.partition`, the lobby of the session host. Fails as
  /// Client::Connect.
  [[nodiscard]] static Result<std::unique_ptr<SessionDirectory>> Connect(
      const ClientOptions& options = {});
  /// The same on a bus that is there already; it outlives the directory.
  [[nodiscard]] static Result<std::unique_ptr<SessionDirectory>> Attach(bus::Bus& bus);

  ~SessionDirectory();
  SessionDirectory(const SessionDirectory&) = delete;
  SessionDirectory& operator=(const SessionDirectory&) = delete;

  /// Waits until a session host is heard of: kTimeout when none is.
  [[nodiscard]] Status WaitForHost(Duration timeout = std::chrono::seconds(3));

  /// Sessions that are there now, by name.
  [[nodiscard]] std::vector<roster::SessionState> Sessions() const;

  /// All sessions of the host, by name: waits until as many are known as it says that it has. Fails
  /// with kTimeout.
  [[nodiscard]] Result<std::vector<roster::SessionState>> List(
      Duration timeout = std::chrono::seconds(3));

  /// Fails with kUnavailable (no host), kTimeout (no answer) or kInvalidArgument (the host's
  /// reason).
  [[nodiscard]] Status Create(const std::string& name, Duration timeout = std::chrono::seconds(3));

 private:
  class Impl;
  explicit SessionDirectory(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace limbcast::client
