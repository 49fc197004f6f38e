#include "common/service/service_command_line.hpp"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <utility>

namespace limbcast::service {

namespace {
constexpr std::uint32_t kMaxDomainId = 101;      // above, ports fall into the ephemeral range
constexpr std::size_t kMaxPartitionLength = 64;  // bound of the wire types that carry it
constexpr std::size_t kMaxTextLength = 255;
constexpr std::size_t kMaxPathLength = 4096;

// "limbcast-fusion" bears the role "fusion"; the program of all commands looks and commands.
std::string RoleOf(const std::string& program) {
  constexpr std::string_view kPrefix = "limbcast-";
  return program.starts_with(kPrefix) ? program.substr(kPrefix.size()) : "operator";
}
}  // namespace

bus::BusConfig ReadBusConfig(const config::Section& section, bus::BusConfig defaults) {
  bus::BusConfig config = std::move(defaults);
  if (section.Has("dds")) {
    const Result<bus::Vendor> vendor = bus::ParseVendor(section.Read("dds", "", kMaxTextLength));
    if (vendor) {
      config.vendor = *vendor;
    } else {
      section.Fail("dds", vendor.error().message);
    }
  }
  config.domain_id = section.Read("domain_id", config.domain_id, 0U, kMaxDomainId);
  config.partition = section.Read("partition", config.partition, kMaxPartitionLength);
  if (section.Has("network")) {
    const Status parsed = bus::ParseNetwork(section.Read("network", "", kMaxTextLength), config);
    if (!parsed) {
      section.Fail("network", parsed.error().message);
    }
  }
  config.peers = section.Read("peers", config.peers);
  config.security_dir = section.Read("security_dir", config.security_dir, kMaxPathLength);
  config.security_role = section.Read("security_role", config.security_role, kMaxTextLength);
  config.ownership_strength =
      section.Read("ownership_strength", config.ownership_strength, 0, 1000);
  config.stream_lease = DurationFromSeconds(
      section.Read("stream_lease_s", ToSeconds(config.stream_lease), 0.05, 60.0));
  config.stream_depth = section.Read("stream_depth", config.stream_depth, 1, 1024);
  config.write_batching = section.Read("write_batching", config.write_batching);
  config.send_loss_permille = section.Read("send_loss_permille", config.send_loss_permille, 0, 500);
  return config;
}

ServiceCommandLine::ServiceCommandLine(std::string program, std::string description,
                                       std::string examples)
    : CommandLine(std::move(program), std::move(description), std::move(examples)) {
  app().add_option("--dds", dds_, "Network library: cyclone (default), fast or inproc");
  app().add_option("--domain", domain_id_, "DDS domain")->type_name("0-101");
  app().add_option("--partition", partition_, "DDS partition: the session to join");
  app().add_option("--network", network_,
                   "loopback (default), lan, wifi, or interface names separated by commas");
  app()
      .add_option("--peer", peers_, "Address of a host to look for; may be given several times")
      ->allow_extra_args(false);
  app()
      .add_option("--security", security_dir_,
                  "DDS Security with the credentials in a folder of `limbcast security create`")
      ->type_name("DIR");
  app().add_option("--security-role", security_role_,
                   "Whose credentials of it (default: those of this program)");
  app()
      .add_option("--log-level", log_level_, "What to say on stderr")
      ->check(CLI::IsMember({"debug", "info", "warning", "error", "off"}));
}

Result<bus::BusConfig> ServiceCommandLine::ReadBus(const config::ConfigFile& file,
                                                   const std::string& role) const {
  bus::BusConfig defaults;
  defaults.security_role = role.empty() ? RoleOf(program()) : role;
  bus::BusConfig config = ReadBusConfig(file.Get("bus"), defaults);
  config.participant_name = program();
  if (dds_) {
    const Result<bus::Vendor> vendor = bus::ParseVendor(*dds_);
    if (!vendor) {
      return Error{vendor.error().code, "--dds " + vendor.error().message};
    }
    config.vendor = *vendor;
  }
  if (network_) {
    if (const Status parsed = bus::ParseNetwork(*network_, config); !parsed) {
      return Error{parsed.error().code, "--network " + parsed.error().message};
    }
  }
  config.domain_id = domain_id_.value_or(config.domain_id);
  config.partition = partition_.value_or(config.partition);
  if (!peers_.empty()) {
    config.peers = peers_;
  }
  config.security_dir = security_dir_.value_or(config.security_dir);
  config.security_role = security_role_.value_or(config.security_role);
  if (const Status valid = bus::Validate(config); !valid) {
    return valid.error();
  }
  return config;
}

void ServiceCommandLine::StartLog() const {
  auto logger = std::make_shared<spdlog::logger>(program(),
                                                 std::make_shared<spdlog::sinks::stderr_sink_mt>());
  logger->set_pattern("%Y-%m-%dT%H:%M:%S.%e %n %l: %v");
  logger->set_level(spdlog::level::from_str(log_level_));
  spdlog::set_default_logger(std::move(logger));
}

}  // namespace limbcast::service
