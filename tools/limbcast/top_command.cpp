#include "tools/limbcast/top_command.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "common/bus/bus_factory.hpp"
#include "common/runtime/stop_signal.hpp"
#include "common/runtime/system_clock.hpp"
#include "tools/limbcast/monitor/pipeline_view.hpp"
#include "tools/limbcast/top/top_table.hpp"

namespace limbcast::tool {
namespace {

struct TopOptions {
  bool once = false;
  bool json = false;
  double interval_s = 1.0;
};

int Top(const service::ServiceCommandLine& line, const TopOptions& options) {
  const auto file = line.LoadConfig();
  if (!file) {
    return line.Fail(file.error());
  }
  const auto bus_config = line.ReadBus(*file);
  if (const Status read = file->Finish(); !read) {
    return line.Fail(read.error());
  }
  if (!bus_config) {
    return line.Fail(bus_config.error());
  }
  const runtime::StopSignal stop;
  const runtime::SystemClock clock;
  const auto bus = bus::Open(*bus_config);
  if (!bus) {
    return line.Fail(bus.error());
  }
  const auto view = PipelineView::Make(**bus, {.segment_states = true, .truth = false});
  if (!view) {
    return line.Fail(view.error());
  }
  const Duration interval = DurationFromSeconds(options.interval_s);
  if (options.once && stop.WaitFor(interval)) {  // everybody says who they are
    return 0;
  }
  const auto count = [&] {
    return (*view)->With([&](const PipelineModel& model) { return CountsOf(model, clock.Now()); });
  };
  TopCounts before = count();
  while (!stop.WaitFor(interval)) {
    const nlohmann::json top = (*view)->With(
        [&](const PipelineModel& model) { return TopJson(model, before, clock.Now()); });
    before = count();
    const bool live = !options.once && !options.json;
    fmt::print("{}{}{}", live ? "\033[H\033[2J" : "", options.json ? top.dump() : TopText(top),
               options.json ? "\n" : "");
    if (std::fflush(stdout) != 0 || options.once) {  // nobody reads the pipe any more
      break;
    }
  }
  return 0;
}

}  // namespace

SubCommand AddTopCommand(service::ServiceCommandLine& line) {
  const auto options = std::make_shared<TopOptions>();
  CLI::App* app = line.app().add_subcommand("top", "Live table of processes, bodies and segments");
  app->add_flag("--once", options->once, "Print one table and end");
  app->add_flag("--json", options->json, "One JSON object a line instead of tables");
  app->add_option("--interval", options->interval_s, "Seconds between two tables")
      ->check(CLI::Range(0.1, 3600.0));
  return {.app = app, .run = [&line, options] { return Top(line, *options); }};
}

}  // namespace limbcast::tool
