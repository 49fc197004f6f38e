#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/limbcast/demo/demo_options.hpp"
#include "tools/limbcast/sub_command.hpp"

namespace limbcast::tool {

/// What the commands that run a whole pipeline share: the libraries it runs on, settings for its
/// processes, where they are, and where the result goes.
struct DemoArguments {
  DemoOptions options;
  std::string dds = "cyclone";
};

/// Adds --dds, --json and --bin to `app`. `arguments` outlive it.
void AddNetworkOfDemo(CLI::App& app, DemoArguments& arguments);

/// Adds these and --service-set, --gateway-set and --fusion-set.
void AddDemoOptions(CLI::App& app, DemoArguments& arguments);

/// Fills what the command line left open: the network of the client, a domain of our own, the
/// folder. Fails with kInvalidArgument, kNotFound or what the configuration file says.
[[nodiscard]] Status Complete(service::ServiceCommandLine& line, DemoArguments& arguments);

/// Writes `result` to --json, if that was given.
[[nodiscard]] Status WriteJson(const DemoArguments& arguments, const nlohmann::json& result);

}  // namespace limbcast::tool
