#include "tools/limbcast/demo_command.hpp"

#include <memory>

#include "tools/limbcast/demo/demo.hpp"
#include "tools/limbcast/demo_arguments.hpp"

namespace limbcast::tool {
namespace {

int RunDemo(service::ServiceCommandLine& line, DemoArguments& arguments) {
  if (const Status complete = Complete(line, arguments); !complete) {
    return line.Fail(complete.error());
  }
  const auto summary = Demo(arguments.options).Run();
  if (!summary) {
    return line.Fail(summary.error());
  }
  if (const Status written = WriteJson(arguments, *summary); !written) {
    return line.Fail(written.error());
  }
  return (*summary)["clean_exit"].get<bool>() ? 0 : 1;
}

}  // namespace

SubCommand AddDemoCommand(service::ServiceCommandLine& line) {
  const auto arguments = std::make_shared<DemoArguments>();
  DemoOptions& options = arguments->options;
  CLI::App* app = line.app().add_subcommand(
      "demo", "Run gateway, fusion and posture as processes on this host, and sum up");
  app->add_option(
         "--recording", options.recording,
         "Play this instead of the simulated person: HDF5, CSV or a folder of text exports")
      ->type_name("PATH");
  app->add_option(
      "--speed", options.speed,
      "Of the recording: a factor, or max (default) for as fast as the pipeline takes it");
  app->add_option("--seconds", options.seconds, "End after so many seconds (default: Ctrl-C)")
      ->check(CLI::Range(0.1, 1e7));
  app->add_flag("--coils", options.coils,
                "The simulated person wears coils on the pelvis: wrists and shins have positions");
  app->add_flag("--markers", options.markers,
                "Cameras see a marker on the simulated person's pelvis");
  AddDemoOptions(*app, *arguments);
  return {.app = app, .run = [&line, arguments] { return RunDemo(line, *arguments); }};
}

}  // namespace limbcast::tool
