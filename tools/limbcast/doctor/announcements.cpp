#include "tools/limbcast/doctor/announcements.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>

namespace limbcast::tool {
namespace {

constexpr const char* kGroup = "239.255.0.1";
constexpr std::size_t kHeader_bytes = 20;
constexpr int kRoom_bytes = 1024 * 1024;  // all that comes while nobody calls Heard

}  // namespace

std::optional<std::string> LibraryOf(std::string_view packet) {
  if (packet.size() < kHeader_bytes || !packet.starts_with("RTPS")) {
    return std::nullopt;
  }
  const unsigned vendor =
      static_cast<unsigned char>(packet[6]) * 256U + static_cast<unsigned char>(packet[7]);
  switch (vendor) {  // https://www.dds-foundation.org/dds-rtps-vendor-and-product-ids/
    case 0x010F:
      return "Fast DDS";
    case 0x0110:
      return "Cyclone DDS";
    default:
      return fmt::format("vendor {:04x}", vendor);
  }
}

AnnouncementListener::AnnouncementListener(std::uint32_t domain,
                                           const std::vector<bus::NetworkInterface>& interfaces)
    : fd_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  const int yes = 1;
  setsockopt(fd_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &kRoom_bytes, sizeof kRoom_bytes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(7400 + 250 * domain));
  inet_pton(AF_INET, kGroup, &address.sin_addr);
  // NOLINTNEXTLINE(*-reinterpret-cast): the interface of bind
  if (bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return;  // hears nothing
  }
  for (const bus::NetworkInterface& interface : interfaces) {
    ip_mreq group{};
    group.imr_multiaddr = address.sin_addr;
    inet_pton(AF_INET, interface.address.c_str(), &group.imr_interface);
    setsockopt(fd_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof group);
  }
}

AnnouncementListener::~AnnouncementListener() { close(fd_); }

std::vector<Announcement> AnnouncementListener::Heard() {
  std::array<char, 2048> packet{};
  sockaddr_in from{};
  socklen_t size = sizeof from;
  for (;;) {
    // NOLINTNEXTLINE(*-reinterpret-cast): the interface of recvfrom
    auto* const sender = reinterpret_cast<sockaddr*>(&from);
    const ssize_t got = recvfrom(fd_, packet.data(), packet.size(), 0, sender, &size);
    if (got < 0) {
      break;
    }
    const auto library = LibraryOf({packet.data(), static_cast<std::size_t>(got)});
    if (library) {
      heard_.insert({bus::Ipv4Text(from.sin_addr), *library});
    }
  }
  return {heard_.begin(), heard_.end()};
}

}  // namespace limbcast::tool
