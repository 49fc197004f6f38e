#include "tools/limbcast/bench/users_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <optional>

#include "tools/limbcast/bench/users_search.hpp"
#include "tools/limbcast/demo/demo.hpp"

namespace limbcast::tool {
namespace {

// Everybody stands still this long, is aligned (2.5 s after the begin), and then walks.
constexpr double kStand_s = 5.0;
constexpr double kSettle_s = kStand_s + 1.0;

// Nothing when it was asked to stop meanwhile.
std::optional<UsersRun> RunOnce(const UsersBenchOptions& options, int people) {
  const DemoOptions demo_options = DemoFor(options, people);
  Demo demo(demo_options);
  const auto summary = demo.Run();
  if (demo.stopped()) {
    return std::nullopt;
  }
  if (!summary) {
    UsersRun run;
    run.people = people;
    run.refused = summary.error().message;
    return run;
  }
  return RunOf(people, *summary);
}

}  // namespace

DemoOptions DemoFor(const UsersBenchOptions& options, int people) {
  DemoOptions demo = options.demo;
  demo.quiet = true;
  demo.settle_seconds = kSettle_s;
  demo.seconds = kSettle_s + options.seconds;
  const auto set = [&demo](std::string setting) {
    demo.gateway_settings.insert(demo.gateway_settings.begin(), std::move(setting));
  };
  set(fmt::format("simulator.persons={}", people));
  set(fmt::format("simulator.n_pose_s={}", kStand_s));
  set("simulator.sensors=reduced15");
  set("gateway.publish_truth=false");  // a real sensor has none
  set("gateway.marg_frame=true");
  return demo;
}

Result<nlohmann::json> BenchUsers(const UsersBenchOptions& options) {
  std::vector<UsersRun> runs;
  bool stopped = false;
  fmt::print("{}", RowHeading());
  const auto try_people = [&](int people) {
    for (int attempt = 0; attempt < options.attempts && !stopped; ++attempt) {
      auto run = RunOnce(options, people);
      if (!run) {
        stopped = true;
        break;
      }
      fmt::print("{}", Row(*run, options.limits));
      std::fflush(stdout);
      runs.push_back(std::move(*run));
      if (Complaint(runs.back(), options.limits).empty()) {
        return true;
      }
    }
    return false;
  };
  if (options.people.empty()) {
    UsersSearch search(options.first, options.max);
    while (search.next() && !stopped) {
      search.Add(try_people(*search.next()));
    }
  } else {
    for (const int people : options.people) {
      (void)try_people(people);
    }
  }
  const bool any = std::any_of(runs.begin(), runs.end(),
                               [](const UsersRun& run) { return run.refused.empty(); });
  if (!any) {
    return Error{ErrorCode::kUnavailable,
                 runs.empty() ? "stopped before the first run ended" : runs.front().refused};
  }
  nlohmann::json report = ReportJson(std::string(ToString(options.demo.dds)), options.limits, runs);
  fmt::print("{}", ReportText(report));
  return report;
}

}  // namespace limbcast::tool
