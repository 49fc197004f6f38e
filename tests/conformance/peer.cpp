#include "tests/conformance/peer.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>

#include "common/base/expects.hpp"

namespace limbcast::conformance {
namespace {

constexpr std::chrono::milliseconds kReplyWithin{30'000};

}  // namespace

ProcessPeer::ProcessPeer(std::string path) {
  std::signal(SIGPIPE, SIG_IGN);  // a peer that is gone is an error reply, not our end
  std::array<int, 2> down{};
  std::array<int, 2> up{};
  Expects(pipe2(down.data(), O_CLOEXEC) == 0 && pipe2(up.data(), O_CLOEXEC) == 0, "two pipes");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, down[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, up[1], STDOUT_FILENO);
  std::array<char*, 2> arguments = {path.data(), nullptr};
  const int failed = posix_spawn(&pid_, path.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(down[0]);
  close(up[1]);
  to_peer_ = down[1];
  from_peer_ = up[0];
  Expects(failed == 0, "a peer process");
}

ProcessPeer::~ProcessPeer() { Reap(); }

void ProcessPeer::Reap() {
  if (pid_ <= 0) {
    return;
  }
  close(to_peer_);  // it ends at the end of its input
  int status = 0;
  waitpid(pid_, &status, 0);
  close(from_peer_);
  pid_ = -1;
}

void ProcessPeer::Kill() {
  kill(pid_, SIGKILL);
  Reap();
}

std::string ProcessPeer::Do(const std::string& line) {
  if (pid_ <= 0) {
    return "error the peer process is gone";
  }
  const std::string text = line + "\n";
  if (write(to_peer_, text.data(), text.size()) != static_cast<ssize_t>(text.size())) {
    return "error the peer process does not listen";
  }
  while (true) {
    if (const auto end = received_.find('\n'); end != std::string::npos) {
      const std::string reply = received_.substr(0, end);
      received_.erase(0, end + 1);
      return reply;
    }
    pollfd waiting{from_peer_, POLLIN, 0};
    if (poll(&waiting, 1, static_cast<int>(kReplyWithin.count())) <= 0) {
      return "error no reply to: " + line;
    }
    std::array<char, 4096> chunk{};
    const ssize_t got = read(from_peer_, chunk.data(), chunk.size());
    if (got <= 0) {
      return "error the peer process ended";
    }
    received_.append(chunk.data(), static_cast<std::size_t>(got));
  }
}

}  // namespace limbcast::conformance
