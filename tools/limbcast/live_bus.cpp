#include "tools/limbcast/live_bus.hpp"

#include <optional>

namespace limbcast::tool {
namespace {

Result<std::unique_ptr<bus::Bus>> OpenIn(const service::ServiceCommandLine& line,
                                         const std::optional<std::string>& partition) {
  const auto file = line.LoadConfig();
  if (!file) {
    return file.error();
  }
  auto bus_config = line.ReadBus(*file);
  if (!bus_config) {
    return bus_config.error();
  }
  bus_config->partition = partition.value_or(bus_config->partition);
  return bus::Open(*bus_config);
}

}  // namespace

Result<std::unique_ptr<bus::Bus>> OpenLiveBus(const service::ServiceCommandLine& line) {
  return OpenIn(line, std::nullopt);
}

Result<std::unique_ptr<bus::Bus>> OpenLiveBus(const service::ServiceCommandLine& line,
                                              const std::string& partition) {
  return OpenIn(line, partition);
}

}  // namespace limbcast::tool
