#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/base/time.hpp"

namespace limbcast::process {

/// How a child ended.
struct ExitState {
  int status = 0;            ///< exit status; meaningless when `signal` is not 0
  int signal = 0;            ///< the signal that ended it, or 0
  double cpu_seconds = 0.0;  ///< user + system time of all its life
  bool operator==(const ExitState&) const = default;
  [[nodiscard]] bool clean() const { return status == 0 && signal == 0; }
};

struct ChildOptions {
  std::vector<std::string> arguments = {};  ///< arguments[0] is the executable, looked up in PATH
  std::string working_directory = {};       ///< "" = that of this process
  /// "NAME=value" put over this process' environment.
  std::vector<std::string> environment = {};
  /// In a session of its own: a Ctrl-C in the terminal does not reach it, and all its descendants
  /// can be found (SessionMembers).
  bool new_session = true;
};

/// A child process with captured stdout and stderr (in memory, no file, no pipe that fills up). It
/// gets SIGKILL when this process' starting thread dies, and when the object goes out of scope.
/// Thread-compatible.
class ChildProcess {
 public:
  /// Fails with kNotFound or kUnavailable, naming the executable and the reason.
  [[nodiscard]] static Result<ChildProcess> Start(const ChildOptions& options);

  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&& other) noexcept;
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  ~ChildProcess();

  [[nodiscard]] pid_t pid() const { return pid_; }

  /// The exit state as soon as the child ended, nothing when it still runs after `timeout`.
  std::optional<ExitState> Wait(Duration timeout);
  /// The same without waiting.
  std::optional<ExitState> Poll() { return Wait(Duration::zero()); }

  /// Does nothing when the child has ended.
  void Signal(int number);

  /// SIGTERM, then SIGKILL when it is still there after `patience`.
  ExitState Stop(Duration patience);

  /// What the child wrote so far.
  [[nodiscard]] std::string Output() const;
  [[nodiscard]] std::string Errors() const;

 private:
  ChildProcess() = default;
  void Release();

  pid_t pid_ = -1;
  int pid_fd_ = -1;
  int output_fd_ = -1;
  int error_fd_ = -1;
  std::optional<ExitState> exit_;
};

/// Processes alive now whose session is `session` (the pid of a child with new_session).
[[nodiscard]] std::vector<pid_t> SessionMembers(pid_t session);

}  // namespace limbcast::process
