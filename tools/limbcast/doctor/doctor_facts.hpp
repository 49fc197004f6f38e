#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/base/ids.hpp"
#include "common/base/time.hpp"
#include "common/bus/bus_config.hpp"
#include "common/bus/events.hpp"
#include "common/bus/network_interfaces.hpp"

namespace limbcast::tool {

/// A participant that announces itself by multicast.
struct Announcement {
  std::string address;  ///< of its host
  std::string library;  ///< "Fast DDS", "Cyclone DDS", or the vendor id
  auto operator<=>(const Announcement&) const = default;
};

/// What a host does with packets to the first discovery ports of the domain.
struct PeerProbe {
  std::string peer{};       ///< as configured
  std::string address{};    ///< empty: the name is unknown
  std::string leaves_by{};  ///< address of this host on the way to it; empty: there is no way
  std::size_t refused = 0;  ///< ports on which nobody listens: its host says so
  std::size_t silent = 0;   ///< ports that somebody listens on, or a firewall hides
  std::size_t blocked = 0;  ///< a firewall says no, here or there
};

/// One process that reports its health.
struct ProcessFacts {
  std::uint64_t process_uid = 0;
  std::string role{};
  std::string host{};
  std::uint32_t pid = 0;
  std::string last_error{};
  std::size_t reports = 0;
  /// The smallest of (received − reported): how far its clock is behind ours, at most. Negative:
  /// how far it is ahead, at least.
  Duration smallest_age{};
};

/// A sensor, by who it says it is and who sends it.
struct SensorFacts {
  std::string serial{};                ///< empty: unknown
  std::vector<std::string> wearers{};  ///< people in the roster that wear it
  std::uint64_t samples = 0;
  std::uint64_t steps_back = 0;  ///< times that its sequence number fell or came again
};

/// An endpoint of somebody that does not fit one of ours.
struct Mismatch {
  bus::BusEventKind kind = bus::BusEventKind::kIncompatibleQos;
  std::string topic{};
  std::string detail{};
  auto operator<=>(const Mismatch&) const = default;
};

/// All that the doctor looks at.
struct DoctorFacts {
  bus::BusConfig config;
  std::string network;  ///< bus::DescribeNetwork
  std::vector<bus::NetworkInterface> host;
  std::string refusal;  ///< of the bus; empty: it is open
  double listened_s = 0.0;

  std::size_t participants_here = 0;  ///< numbers of the domain in use on this host, ours included
  std::vector<std::string> stale_shared_memory;
  std::int64_t receive_buffer_bytes = 0;  ///< that a socket may have at most; 0 = unknown
  std::vector<PeerProbe> probes;
  std::vector<Announcement> announcements;

  std::int32_t peers_matched = 0;  ///< endpoints that talk to ours
  std::map<std::uint64_t, ProcessFacts> processes;
  std::map<SensorUid, SensorFacts> sensors;
  std::vector<Mismatch> mismatches;

  std::optional<Duration> credentials_left;  ///< until our identity expires
};

}  // namespace limbcast::tool
