#include "tools/limbcast/doctor/peer_probe.hpp"

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <utility>
#include <vector>

#include "common/bus/network_interfaces.hpp"

namespace limbcast::tool {
namespace {

constexpr std::uint32_t kPorts = 8;

// DDSI-RTPS 2.2, 9.4.4: protocol, version 2.2, vendor unknown, a GUID prefix of nobody; no
// submessage, so that who hears it has nothing to do.
constexpr std::array<char, 20> kEmptyMessage = {'R', 'T', 'P', 'S', 2, 2};

class Socket {
 public:
  explicit Socket(const sockaddr_in& to) : fd_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    // NOLINTNEXTLINE(*-reinterpret-cast): the interface of connect
    connected_ = connect(fd_, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
  }
  ~Socket() { close(fd_); }
  Socket(Socket&& other) noexcept
      : fd_(std::exchange(other.fd_, -1)), connected_(other.connected_) {}
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  [[nodiscard]] int fd() const { return fd_; }
  [[nodiscard]] bool connected() const { return connected_; }
  // 0 or what the system says about sending now.
  [[nodiscard]] int Send() const {
    return send(fd_, kEmptyMessage.data(), kEmptyMessage.size(), 0) < 0 ? errno : 0;
  }
  // What came back meanwhile: an ICMP message shows as an error.
  [[nodiscard]] int TakeError() const {
    int error = 0;
    socklen_t size = sizeof error;
    getsockopt(fd_, SOL_SOCKET, SO_ERROR, &error, &size);
    return error;
  }

 private:
  int fd_;
  bool connected_ = false;
};

std::string OwnAddress(const Socket& socket) {
  sockaddr_in own{};
  socklen_t size = sizeof own;
  // NOLINTNEXTLINE(*-reinterpret-cast): the interface of getsockname
  if (getsockname(socket.fd(), reinterpret_cast<sockaddr*>(&own), &size) != 0) {
    return {};
  }
  return bus::Ipv4Text(own.sin_addr);
}

void Count(int error, PeerProbe& probe) {
  if (error == ECONNREFUSED) {
    ++probe.refused;
  } else if (error == 0) {
    ++probe.silent;
  } else {  // EPERM: a rule of this host; EHOSTUNREACH, EACCES: one on the way
    ++probe.blocked;
  }
}

}  // namespace

PeerProbe ProbePeer(const std::string& peer, std::uint32_t domain, Duration patience) {
  PeerProbe probe{.peer = peer};
  const auto resolved = bus::ResolveIpv4(peer.substr(0, peer.find(':')));
  if (!resolved) {
    return probe;
  }
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr = *resolved;
  probe.address = bus::Ipv4Text(address.sin_addr);
  std::vector<Socket> sockets;
  for (std::uint32_t number = 0; number < kPorts; ++number) {
    address.sin_port = htons(static_cast<std::uint16_t>(7410 + 250 * domain + 2 * number));
    Socket socket(address);
    if (!socket.connected()) {
      return probe;  // no route: leaves_by stays empty
    }
    probe.leaves_by = OwnAddress(socket);
    if (const int error = socket.Send(); error != 0 && error != ECONNREFUSED) {
      Count(error, probe);
    } else {
      sockets.push_back(std::move(socket));
    }
  }
  std::vector<pollfd> waiting;
  waiting.reserve(sockets.size());
  for (const Socket& socket : sockets) {
    waiting.push_back({socket.fd(), 0, 0});
  }
  // Until each has an error, or patience ends.
  const auto end = std::chrono::steady_clock::now() + patience;
  while (!waiting.empty()) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        end - std::chrono::steady_clock::now());
    if (left.count() <= 0 ||
        poll(waiting.data(), waiting.size(), static_cast<int>(left.count())) <= 0) {
      break;
    }
    std::erase_if(waiting, [](const pollfd& one) { return one.revents != 0; });
  }
  for (const Socket& socket : sockets) {
    Count(socket.TakeError(), probe);
  }
  return probe;
}

}  // namespace limbcast::tool
