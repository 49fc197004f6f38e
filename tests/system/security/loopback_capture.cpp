#include "tests/system/security/loopback_capture.hpp"

#include <arpa/inet.h>
#include <linux/if_ether.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <system_error>

namespace limbcast::security_test {
namespace {

constexpr std::uint32_t kPortBase = 7400;
constexpr std::uint32_t kPortsPerDomain = 250;
constexpr std::size_t kIpHeader = 20;  // without options: what Linux sends
constexpr std::size_t kUdpHeader = 8;
constexpr std::uint8_t kUdp = 17;

std::uint32_t PortAt(const std::string& packet, std::size_t at) {
  return static_cast<std::uint32_t>(static_cast<std::uint8_t>(packet[at]) << 8U) |
         static_cast<std::uint8_t>(packet[at + 1]);
}

}  // namespace

Result<std::unique_ptr<LoopbackCapture>> LoopbackCapture::Start(std::uint32_t domain) {
  const int fd = socket(AF_PACKET, SOCK_DGRAM | SOCK_CLOEXEC, htons(ETH_P_IP));
  if (fd < 0) {
    return Error{ErrorCode::kUnavailable,
                 "no packet socket: " + std::error_code(errno, std::generic_category()).message()};
  }
  const int room_bytes = 64 * 1024 * 1024;
  setsockopt(fd, SOL_SOCKET, SO_RCVBUFFORCE, &room_bytes, sizeof room_bytes);
  sockaddr_ll loopback{};
  loopback.sll_family = AF_PACKET;
  loopback.sll_protocol = htons(ETH_P_IP);
  loopback.sll_ifindex = static_cast<int>(if_nametoindex("lo"));
  // NOLINTNEXTLINE(*-reinterpret-cast): the interface of bind
  if (bind(fd, reinterpret_cast<const sockaddr*>(&loopback), sizeof loopback) != 0) {
    close(fd);
    return Error{ErrorCode::kUnavailable, "the packet socket cannot be bound to lo"};
  }
  return std::unique_ptr<LoopbackCapture>(
      new LoopbackCapture(fd, kPortBase + kPortsPerDomain * domain));
}

LoopbackCapture::LoopbackCapture(int socket, std::uint32_t first_port)
    : socket_(socket), first_port_(first_port), thread_([this] { Run(); }) {}

LoopbackCapture::~LoopbackCapture() {
  (void)Stop();
  close(socket_);
}

const std::vector<std::string>& LoopbackCapture::Stop() {
  stop_ = true;
  if (thread_.joinable()) {
    thread_.join();
  }
  return packets_;
}

void LoopbackCapture::Run() {
  std::string buffer(64 * 1024, '\0');
  for (;;) {
    pollfd ready{socket_, POLLIN, 0};
    if (poll(&ready, 1, 50) <= 0) {
      if (stop_) {  // and nothing is left to read
        return;
      }
      continue;
    }
    const ssize_t got = recv(socket_, buffer.data(), buffer.size(), 0);
    if (got < static_cast<ssize_t>(kIpHeader + kUdpHeader) ||
        static_cast<std::uint8_t>(buffer[9]) != kUdp) {
      continue;
    }
    const std::uint32_t to = PortAt(buffer, kIpHeader + 2);
    if (to >= first_port_ && to < first_port_ + kPortsPerDomain) {
      packets_.push_back(buffer.substr(kIpHeader + kUdpHeader,
                                       static_cast<std::size_t>(got) - kIpHeader - kUdpHeader));
    }
  }
}

}  // namespace limbcast::security_test
