#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/base/time.hpp"

namespace limbcast::bus {

enum class Vendor : std::uint8_t { kCyclone, kFast, kInproc };

enum class NetworkProfile : std::uint8_t {
  kLoopback,    ///< this host only, no multicast: hermetic
  kLan,         ///< the interface the DDS library chooses, multicast discovery
  kInterfaces,  ///< lan on the interfaces named in `interfaces`
  /// Samples never by multicast, which Wi-Fi sends at its slowest rate and does not repeat.
  /// Participants are found by calling `peers`; only where there are none, by multicast.
  kWifi,
};

/// Which network a process joins, and how.
struct BusConfig {
  /// "cyclone", "fast" or "inproc" in files and on command lines.
  Vendor vendor = Vendor::kCyclone;

  /// DDS domain. Range: [0, 101]; above that the ports fall into the ephemeral range.
  std::uint32_t domain_id = 42;

  /// DDS partition: one session. Empty = the default partition.
  std::string partition;

  NetworkProfile network = NetworkProfile::kLoopback;

  /// Interface names or addresses for kInterfaces, and for kWifi where the library is not to
  /// choose.
  std::vector<std::string> interfaces;

  /// Unicast peers (addresses) beside what discovery finds.
  std::vector<std::string> peers;

  /// Name of the participant in DDS tools and in events, e.g. "limbcast-fusion". At most 64
  /// characters.
  std::string participant_name = "limbcast";

  /// EXCLUSIVE ownership strength of this process' writers: the highest alive one is heard. Range:
  /// [0, 1000].
  std::int32_t ownership_strength = 10;

  /// A stream writer silent for this long counts as gone. Range: [50 ms, 60 s].
  Duration stream_lease = std::chrono::milliseconds(500);

  /// Samples kept for each instance of a stream. Range: [1, 1024].
  std::int32_t stream_depth = 16;

  /// Folder of `limbcast security create`: DDS Security with the credentials of `security_role` in
  /// it. Everything is encrypted and only bearers of the same authority's credentials are heard.
  /// Empty = no security.
  std::string security_dir;

  /// Which role's credentials (security::DefaultRoles); decides what may be published and heard.
  std::string security_role = "spectator";

  /// Gather small samples into packets until Flush (Cyclone only; the others ignore it).
  bool write_batching = false;

  /// So many of 1000 packets are not sent, to rehearse a bad network (Cyclone only; the others
  /// ignore it). Range: [0, 500].
  std::int32_t send_loss_permille = 0;
};

[[nodiscard]] Status Validate(const BusConfig& config);

/// "cyclone" | "fast" | "inproc".
[[nodiscard]] Result<Vendor> ParseVendor(const std::string& text);
/// "loopback" | "lan" | "wifi" | a comma-separated list of interface names or addresses (fills
/// `interfaces`), also after "lan:" or "wifi:".
[[nodiscard]] Status ParseNetwork(const std::string& text, BusConfig& config);

}  // namespace limbcast::bus
