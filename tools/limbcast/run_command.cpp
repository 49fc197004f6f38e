#include "tools/limbcast/run_command.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>

#include "common/bus/bus_factory.hpp"
#include "common/runtime/stop_signal.hpp"
#include "common/runtime/system_clock.hpp"
#include "services/gateway/gateway_command_line.hpp"
#include "tools/limbcast/run/all_in_one.hpp"

namespace limbcast::tool {
namespace {

struct RunOptions {
  std::string recording;
  std::string speed;
  double seconds = 0.0;
};

Result<config::ConfigFile> LoadConfig(const service::ServiceCommandLine& line,
                                      const RunOptions& options) {
  auto file = line.LoadConfig();
  if (!file) {
    return file;
  }
  std::vector<std::string> assignments;
  if (!options.recording.empty()) {
    assignments = {"gateway.driver=replay", "gateway.exit_at_end=true",
                   "replay.recording=" + gateway::TomlString(options.recording)};
  }
  if (!options.speed.empty()) {
    assignments.push_back("gateway.speed=" + options.speed);
  }
  for (const std::string& assignment : assignments) {
    if (const Status done = file->Override(assignment); !done) {
      return done.error();
    }
  }
  return file;
}

int RunAll(const service::ServiceCommandLine& line, const RunOptions& options) {
  const auto file = LoadConfig(line, options);
  if (!file) {
    return line.Fail(file.error());
  }
  const auto config = ReadAllInOne(*file);
  const auto bus_config = line.ReadBus(*file, "pipeline");
  if (const Status read = file->Finish(); !read) {
    return line.Fail(read.error());
  }
  if (!config) {
    return line.Fail(config.error());
  }
  if (!bus_config) {
    return line.Fail(bus_config.error());
  }
  runtime::StopSignal stop;
  const runtime::SystemClock clock;
  service::BusEvents events;
  const auto bus = bus::Open(*bus_config, events.handler());
  if (!bus) {
    return line.Fail(bus.error());
  }
  const auto all = AllInOne::Make(*config, clock, **bus, &events, [&stop] { stop.Trigger(); });
  if (!all) {
    return line.Fail(all.error());
  }
  if (const Status started = (*all)->Start(); !started) {
    return line.Fail(started.error());
  }
  fmt::print("on {}\nCtrl-C ends it; `limbcast top --domain {}` shows it\n", (*bus)->Describe(),
             bus_config->domain_id);
  std::fflush(stdout);
  if (options.seconds > 0.0) {
    stop.WaitFor(DurationFromSeconds(options.seconds));
  } else {
    stop.Wait();
  }
  (*all)->Stop();
  fmt::print("{}\n", gateway::ToText((*all)->Summary()));
  const Status result = (*all)->result();
  return result ? 0 : line.Fail(result.error());
}

}  // namespace

SubCommand AddRunCommand(service::ServiceCommandLine& line) {
  const auto options = std::make_shared<RunOptions>();
  CLI::App* app =
      line.app().add_subcommand("run", "Run gateway, fusion and posture in this process");
  app->add_option("--recording", options->recording, "Play this instead of the simulated person")
      ->type_name("PATH");
  app->add_option("--speed", options->speed,
                  "Of a recording: a factor, or max for as fast as the pipeline takes it");
  app->add_option("--seconds", options->seconds, "End after so many seconds (default: Ctrl-C)")
      ->check(CLI::Range(0.1, 1e7));
  return {.app = app, .run = [&line, options] { return RunAll(line, *options); }};
}

}  // namespace limbcast::tool
