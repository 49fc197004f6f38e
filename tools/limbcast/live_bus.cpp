#include "tools/limbcast/live_bus.hpp"

namespace limbcast::tool {

Result<std::unique_ptr<bus::Bus>> OpenLiveBus(const service::ServiceCommandLine& line) {
  const auto file = line.LoadConfig();
  if (!file) {
    return file.error();
  }
  const auto bus_config = line.ReadBus(*file);
  if (!bus_config) {
    return bus_config.error();
  }
  return bus::Open(*bus_config);
}

}  // namespace limbcast::tool
