#include "tools/limbcast/demo_arguments.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "tools/limbcast/demo/free_domain.hpp"

namespace limbcast::tool {
namespace {

const std::map<std::string, DemoDds> kDdsNames = {
    {"cyclone", DemoDds::kCyclone}, {"fast", DemoDds::kFast}, {"mixed", DemoDds::kMixed}};

}  // namespace

void AddNetworkOfDemo(CLI::App& app, DemoArguments& arguments) {
  app.add_option("--dds", arguments.dds, "cyclone (default), fast or mixed");
  app.add_option("--json", arguments.options.json_path, "Write the result there as one JSON object")
      ->type_name("FILE");
  app.add_option("--bin", arguments.options.folder,
                 "Where the executables are (default: beside this one)")
      ->type_name("FOLDER");
}

void AddDemoOptions(CLI::App& app, DemoArguments& arguments) {
  DemoOptions& options = arguments.options;
  AddNetworkOfDemo(app, arguments);
  app.add_option("--service-set", options.service_settings,
                 "A setting for all three services, e.g. bus.write_batching=false")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  app.add_option("--gateway-set", options.gateway_settings, "A setting for the gateway")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  app.add_option("--fusion-set", options.fusion_settings,
                 "A setting for the fusion service, e.g. filter.name=ckf")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

Status Complete(service::ServiceCommandLine& line, DemoArguments& arguments) {
  DemoOptions& options = arguments.options;
  const auto dds = kDdsNames.find(arguments.dds);
  if (dds == kDdsNames.end()) {
    return Error{ErrorCode::kInvalidArgument,
                 fmt::format("--dds must be cyclone, fast or mixed, is '{}'", arguments.dds)};
  }
  options.dds = dds->second;
  const auto file = line.LoadConfig();
  if (!file) {
    return file.error();
  }
  auto bus_config = line.ReadBus(*file);
  if (Status read = file->Finish(); !read) {
    return read;
  }
  if (!bus_config) {
    return bus_config.error();
  }
  options.bus = *bus_config;
  options.bus.participant_name = "limbcast-demo";
  options.bus.stream_depth = 1024;  // a recording played at full speed comes in gusts
  options.bus.vendor =
      VendorOf(options.dds, "client") == "fast" ? bus::Vendor::kFast : bus::Vendor::kCyclone;
  if (line.app().count("--domain") == 0) {
    const auto domain = FindFreeDomain();
    if (!domain) {
      return domain.error();
    }
    options.bus.domain_id = *domain;
  }
  if (!options.recording.empty() && (options.coils || options.markers)) {
    return Error{ErrorCode::kInvalidArgument,
                 "--coils and --markers are of the simulated person, not of a --recording"};
  }
  if (!options.recording.empty() && !std::filesystem::exists(options.recording)) {
    return Error{ErrorCode::kNotFound,
                 fmt::format("--recording {}: no such file or folder", options.recording)};
  }
  if (options.folder.empty()) {
    options.folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  }
  if (!options.json_path.empty() && !std::ofstream(options.json_path)) {
    return Error{ErrorCode::kInvalidArgument,
                 fmt::format("--json {}: cannot be written", options.json_path)};
  }
  return Ok();
}

Status WriteJson(const DemoArguments& arguments, const nlohmann::json& result) {
  const std::string& path = arguments.options.json_path;
  if (path.empty()) {
    return Ok();
  }
  std::ofstream file(path);
  file << result.dump(2) << '\n';
  if (!file.flush()) {
    return Error{ErrorCode::kUnavailable, fmt::format("--json {}: cannot be written", path)};
  }
  return Ok();
}

}  // namespace limbcast::tool
