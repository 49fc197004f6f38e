#include "tools/limbcast/calibrate_body_command.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "common/client/client.hpp"
#include "common/runtime/stop_signal.hpp"
#include "common/runtime/system_clock.hpp"
#include "common/units/units.hpp"
#include "tools/limbcast/calibrate/body_guide.hpp"
#include "tools/limbcast/live_bus.hpp"

namespace limbcast::tool {
namespace {

struct BodyCommandOptions {
  std::uint32_t body = 1;
  BodyGuideOptions guide;
  std::optional<double> facing_deg;
};

int CalibrateBody(const service::ServiceCommandLine& line, const BodyCommandOptions& options) {
  runtime::StopSignal stop;
  const runtime::SystemClock clock;
  const auto bus = OpenLiveBus(line);
  if (!bus) {
    return line.Fail(bus.error());
  }
  const auto client = client::Client::Attach(**bus, clock);
  if (!client) {
    return line.Fail(client.error());
  }
  BodyGuideOptions guide_options = options.guide;
  if (options.facing_deg) {
    guide_options.facing_rad = units::RadFromDeg(*options.facing_deg);
  }
  const BodyGuide guide{
      .ask =
          [&](roster::CommandKind kind, const std::string& text,
              const std::vector<double>& numbers) {
            return (*client)->Send(kind, BodyId{options.body}, text, numbers);
          },
      .say =
          [](const std::string& text) {
            fmt::print("{}\n", text);
            std::fflush(stdout);
          },
      .wait = [&](double seconds) { return !stop.WaitFor(DurationFromSeconds(seconds)); }};
  const auto done = GuideBody(guide, guide_options);
  if (!done) {
    return line.Fail(done.error());
  }
  fmt::print("{}\n", *done);
  return 0;
}

}  // namespace

SubCommand AddCalibrateBody(CLI::App& calibrate, service::ServiceCommandLine& line) {
  const auto options = std::make_shared<BodyCommandOptions>();
  CLI::App* app = calibrate.add_subcommand(
      "body",
      "How the sensors sit on a person: stand in the reference pose, then walk.\nExample:\n  "
      "limbcast calibrate body --body 1 --walk 20 --profile Anna");
  app->add_option("--body", options->body, "Number of the body")->check(CLI::Range(0U, UINT32_MAX));
  app->add_option("--pose", options->guide.pose, "n_pose: arms hanging; t_pose: arms out")
      ->check(CLI::IsMember({"n_pose", "t_pose"}));
  app->add_option("--facing-deg", options->facing_deg,
                  "The way the person faces in it, counter-clockwise from east")
      ->check(CLI::Range(-360.0, 360.0));
  app->add_option("--countdown", options->guide.countdown_s, "Seconds to get into the pose")
      ->check(CLI::Range(0.0, 60.0));
  app->add_option("--walk", options->guide.walk_s,
                  "Seconds of walking; 0 = none, for sensors with a magnetometer")
      ->check(CLI::Range(0.0, 40.0));
  app->add_option("--profile", options->guide.profile, "Save it under this name as well");
  return {.app = app, .run = [&line, options] { return CalibrateBody(line, *options); }};
}

}  // namespace limbcast::tool
