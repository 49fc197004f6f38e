#include "common/client/network.hpp"

#include "common/bus/bus_factory.hpp"

namespace limbcast::client {
namespace {

std::string SecurityRoleOf(const ClientOptions& options) {
  if (!options.security_role.empty()) {
    return options.security_role;
  }
  switch (options.role) {
    case roster::Role::kPerformer:
      return "performer";
    case roster::Role::kOperator:
      return "operator";
    case roster::Role::kSpectator:
      break;
  }
  return "spectator";
}

}  // namespace

bool OnlyListens(const ClientOptions& options) {
  return !options.security_dir.empty() && SecurityRoleOf(options) == "spectator";
}

Result<std::unique_ptr<bus::Bus>> OpenNetwork(const ClientOptions& options) {
  bus::BusConfig config;
  const auto vendor = bus::ParseVendor(options.dds);
  if (!vendor) {
    return vendor.error();
  }
  config.vendor = *vendor;
  config.domain_id = options.domain_id;
  config.partition = options.session.empty() ? options.partition : options.session;
  config.participant_name = options.name;
  if (const Status network = bus::ParseNetwork(options.network, config); !network) {
    return network.error();
  }
  config.peers = options.peers;
  config.security_dir = options.security_dir;
  config.security_role = SecurityRoleOf(options);
  return bus::Open(config);
}

}  // namespace limbcast::client
