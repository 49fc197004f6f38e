#include "common/client/network.hpp"

#include "common/bus/bus_factory.hpp"

namespace limbcast::client {

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
  return bus::Open(config);
}

}  // namespace limbcast::client
