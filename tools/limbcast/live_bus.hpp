#pragma once

#include <memory>
#include <string>

#include "common/base/result.hpp"
#include "common/bus/bus_factory.hpp"
#include "common/service/service_command_line.hpp"

namespace limbcast::tool {

/// Joins the network that the command line and the [bus] table of its file name; other tables may
/// be a service's and are passed over. A command makes its StopSignal first.
[[nodiscard]] Result<std::unique_ptr<bus::Bus>> OpenLiveBus(
    const service::ServiceCommandLine& line);

/// The same in another partition than these name: a session.
[[nodiscard]] Result<std::unique_ptr<bus::Bus>> OpenLiveBus(const service::ServiceCommandLine& line,
                                                            const std::string& partition);

}  // namespace limbcast::tool
