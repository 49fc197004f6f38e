#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tools/limbcast/doctor/doctor_facts.hpp"

namespace limbcast::tool {

/// The library that sent an RTPS message, by its vendor id; nothing when it is no RTPS message.
[[nodiscard]] std::optional<std::string> LibraryOf(std::string_view packet);

/// Hears who announces participants of a domain by multicast (239.255.0.1, DDSI-RTPS 2.2, 9.6.1.4),
/// beside the DDS library and without it. Not thread-safe.
class AnnouncementListener {
 public:
  /// On the given interfaces; one that refuses multicast is left out.
  AnnouncementListener(std::uint32_t domain, const std::vector<bus::NetworkInterface>& interfaces);
  ~AnnouncementListener();
  AnnouncementListener(const AnnouncementListener&) = delete;
  AnnouncementListener& operator=(const AnnouncementListener&) = delete;

  /// All that came so far.
  [[nodiscard]] std::vector<Announcement> Heard();

 private:
  int fd_ = -1;
  std::set<Announcement> heard_;
};

}  // namespace limbcast::tool
