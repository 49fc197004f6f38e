#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/base/time.hpp"
#include "common/roster/session.hpp"

namespace limbcast::bus {
class Bus;
}

namespace limbcast::client {

/// Which network to join, as whom, and how much to remember.
struct ClientOptions {
  std::string dds = "cyclone";   ///< "cyclone" | "fast" | "inproc"; both DDS hear each other
  std::uint32_t domain_id = 42;  ///< range: [0, 101]
  std::string partition{};       ///< without a session host; empty = the default one
  /// "loopback" | "lan" | "wifi" | interface names, comma-separated, also after "wifi:"
  std::string network = "loopback";
  std::vector<std::string> peers{};      ///< hosts to look for where multicast does not pass
  std::string name = "limbcast-client";  ///< in tools and logs; at most 64 characters
  std::size_t history = 64;              ///< skeletons kept for each body. Range: [2, 4096]
  Duration max_prediction = std::chrono::milliseconds(50);  ///< range: [0, 1 s]

  std::string session{};                         ///< to join, in place of `partition`; empty = none
  roster::Role role = roster::Role::kSpectator;  ///< in the session
  std::string person = "guest";                  ///< in the session; 1 to 64 bytes
  std::vector<roster::SensorAssignment> sensors{};  ///< a performer's
  Duration join_timeout = std::chrono::seconds(5);  ///< for the session host to answer

  /// Folder of `limbcast security create` on a secured network; empty = none. As a spectator the
  /// client then only listens: it joins no session (the host does not count it) and sends nothing.
  std::string security_dir{};
  std::string security_role{};  ///< whose credentials of it; empty = those of `role`
};

}  // namespace limbcast::client
