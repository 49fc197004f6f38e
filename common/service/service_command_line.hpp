#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/bus/bus_config.hpp"
#include "common/config/command_line.hpp"

namespace limbcast::service {

/// Reads a [bus] table. Keys: dds ("cyclone" | "fast" | "inproc"), domain_id, partition, network
/// ("loopback" | "lan" | interfaces, separated by commas), peers, security_dir, security_role,
/// ownership_strength, stream_lease_s, stream_depth, write_batching, send_loss_permille. Refusals
/// are remembered in the section's file.
[[nodiscard]] bus::BusConfig ReadBusConfig(const config::Section& section,
                                           bus::BusConfig defaults = {});

/// The command line that all services share: that of config::CommandLine and the options that say
/// which network to join: --dds, --domain, --partition, --network, --peer,
/// --security, and --log-level.
class ServiceCommandLine : public config::CommandLine {
 public:
  ServiceCommandLine(std::string program, std::string description, std::string examples);

  /// The [bus] table of `file` (marks it as read) with the command line put over it; the
  /// participant is named after the program. On a secured network it bears `role` unless the user
  /// says another; empty = the role that the program is named after.
  [[nodiscard]] Result<bus::BusConfig> ReadBus(const config::ConfigFile& file,
                                               const std::string& role = "") const;

  /// Sends the log to stderr in the level of --log-level, one line an event, named `program`.
  void StartLog() const;

 private:
  std::optional<std::string> dds_;
  std::optional<std::uint32_t> domain_id_;
  std::optional<std::string> partition_;
  std::optional<std::string> network_;
  std::vector<std::string> peers_;
  std::optional<std::string> security_dir_;
  std::optional<std::string> security_role_;
  std::string log_level_ = "info";
};

}  // namespace limbcast::service
