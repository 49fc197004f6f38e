#include "tools/process/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

namespace limbcast::process {
namespace {

void CloseIfOpen(int& fd) {
  if (fd >= 0) {
    close(fd);
    fd = -1;
  }
}

std::string ReadAll(int fd) {
  std::string text;
  std::array<char, 4096> block{};
  while (true) {
    const ssize_t got = pread(fd, block.data(), block.size(), static_cast<off_t>(text.size()));
    if (got <= 0) {
      return text;
    }
    text.append(block.data(), static_cast<std::size_t>(got));
  }
}

std::vector<char*> Pointers(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  pointers.reserve(texts.size() + 1);
  for (std::string& text : texts) {
    pointers.push_back(text.data());
  }
  pointers.push_back(nullptr);
  return pointers;
}

std::string NameOf(const std::string& assignment) {
  return assignment.substr(0, assignment.find('=') + 1);
}

std::vector<std::string> Environment(const std::vector<std::string>& added) {
  std::vector<std::string> all = added;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    const bool replaced = std::any_of(added.begin(), added.end(), [&](const std::string& a) {
      return text.starts_with(NameOf(a));
    });
    if (!replaced) {
      all.push_back(text);
    }
  }
  return all;
}

// Runs in the child between fork and exec: async-signal-safe calls only.
[[noreturn]] void Exec(const ChildOptions& options, char** arguments, char** environment,
                       int output, int errors, int report) {
  if (options.new_session) {
    setsid();
  }
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  sigset_t none;
  sigemptyset(&none);
  pthread_sigmask(SIG_SETMASK, &none, nullptr);
  const int input = open("/dev/null", O_RDONLY | O_CLOEXEC);  // NOLINT(*-vararg): POSIX
  dup2(input, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(errors, STDERR_FILENO);
  // Files of this process are none of the child's: the DDS libraries open their sockets without
  // O_CLOEXEC, and a child that keeps one keeps the port.
  close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);
  if (options.working_directory.empty() || chdir(options.working_directory.c_str()) == 0) {
    execvpe(arguments[0], arguments, environment);
  }
  const int reason = errno;
  [[maybe_unused]] const ssize_t written = write(report, &reason, sizeof reason);
  _exit(127);
}

}  // namespace

Result<ChildProcess> ChildProcess::Start(const ChildOptions& options) {
  Expects(!options.arguments.empty(), "an executable to start");
  std::vector<std::string> arguments = options.arguments;
  std::vector<std::string> environment = Environment(options.environment);
  const std::vector<char*> argument_pointers = Pointers(arguments);
  const std::vector<char*> environment_pointers = Pointers(environment);

  ChildProcess child;
  child.output_fd_ = memfd_create("stdout", MFD_CLOEXEC);
  child.error_fd_ = memfd_create("stderr", MFD_CLOEXEC);
  std::array<int, 2> report{-1, -1};
  if (child.output_fd_ < 0 || child.error_fd_ < 0 || pipe2(report.data(), O_CLOEXEC) != 0) {
    return Error{ErrorCode::kUnavailable,
                 "cannot start " + arguments[0] + ": " + std::generic_category().message(errno)};
  }
  // O_APPEND: what several descendants write does not overwrite each other.
  fcntl(child.output_fd_, F_SETFL, O_APPEND);  // NOLINT(*-vararg): POSIX
  fcntl(child.error_fd_, F_SETFL, O_APPEND);   // NOLINT(*-vararg): POSIX

  const pid_t pid = fork();
  if (pid == 0) {
    Exec(options, const_cast<char**>(argument_pointers.data()),  // NOLINT: exec's signature
         const_cast<char**>(environment_pointers.data()),        // NOLINT: exec's signature
         child.output_fd_, child.error_fd_, report[1]);
  }
  int reason = pid < 0 ? errno : 0;
  close(report[1]);
  if (pid > 0 && read(report[0], &reason, sizeof reason) > 0) {
    waitpid(pid, nullptr, 0);
  }
  close(report[0]);
  if (reason != 0) {
    return Error{reason == ENOENT ? ErrorCode::kNotFound : ErrorCode::kUnavailable,
                 "cannot start " + arguments[0] + ": " + std::generic_category().message(reason)};
  }
  child.pid_ = pid;
  // Not pidfd_open: the header of glibc 2.36 lacks its extern "C".
  child.pid_fd_ = static_cast<int>(syscall(SYS_pidfd_open, pid, 0));  // NOLINT(*-vararg): POSIX
  return child;
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept { *this = std::move(other); }

ChildProcess& ChildProcess::operator=(ChildProcess&& other) noexcept {
  if (this != &other) {
    Release();
    pid_ = std::exchange(other.pid_, -1);
    pid_fd_ = std::exchange(other.pid_fd_, -1);
    output_fd_ = std::exchange(other.output_fd_, -1);
    error_fd_ = std::exchange(other.error_fd_, -1);
    exit_ = std::exchange(other.exit_, std::nullopt);
  }
  return *this;
}

ChildProcess::~ChildProcess() { Release(); }

void ChildProcess::Release() {
  if (pid_ > 0 && !exit_) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  pid_ = -1;
  CloseIfOpen(pid_fd_);
  CloseIfOpen(output_fd_);
  CloseIfOpen(error_fd_);
}

std::optional<ExitState> ChildProcess::Wait(Duration timeout) {
  if (exit_ || pid_ <= 0) {
    return exit_;
  }
  const auto timeout_ms = std::chrono::duration_cast<std::chrono::milliseconds>(timeout).count();
  pollfd waiting{pid_fd_, POLLIN, 0};
  poll(&waiting, 1, static_cast<int>(std::clamp<std::int64_t>(timeout_ms, 0, 86'400'000)));
  int status = 0;
  rusage usage{};
  if (wait4(pid_, &status, WNOHANG, &usage) != pid_) {
    return std::nullopt;
  }
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  exit_ = ExitState{.status = WIFEXITED(status) ? WEXITSTATUS(status) : 0,
                    .signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0,
                    .cpu_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime)};
  return exit_;
}

void ChildProcess::Signal(int number) {
  if (pid_ > 0 && !exit_) {
    kill(pid_, number);
  }
}

ExitState ChildProcess::Stop(Duration patience) {
  Signal(SIGTERM);
  if (const auto ended = Wait(patience)) {
    return *ended;
  }
  Signal(SIGKILL);
  return Wait(std::chrono::hours(1)).value_or(ExitState{.status = 0, .signal = SIGKILL});
}

std::string ChildProcess::Output() const { return ReadAll(output_fd_); }
std::string ChildProcess::Errors() const { return ReadAll(error_fd_); }

std::vector<pid_t> SessionMembers(pid_t session) {
  std::vector<pid_t> members;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/proc", ignored)) {
    const std::string name = entry.path().filename();
    pid_t pid = 0;
    if (std::from_chars(name.data(), name.data() + name.size(), pid).ec != std::errc{}) {
      continue;
    }
    std::ifstream file(entry.path() / "stat");
    std::string line;
    std::getline(file, line);
    // pid (name) state ppid pgrp session ...; the name may hold spaces and brackets.
    const auto after_name = line.rfind(')');
    if (after_name == std::string::npos) {
      continue;
    }
    std::istringstream fields(line.substr(after_name + 1));
    char state = 'Z';
    pid_t parent = 0;
    pid_t group = 0;
    pid_t its_session = 0;
    if (fields >> state >> parent >> group >> its_session && its_session == session &&
        state != 'Z') {
      members.push_back(pid);
    }
  }
  return members;
}

}  // namespace limbcast::process
