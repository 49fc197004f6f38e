#include "tools/limbcast/bench_command.hpp"

#include <memory>

#include "tools/limbcast/bench/users_bench.hpp"
#include "tools/limbcast/demo_arguments.hpp"

namespace limbcast::tool {
namespace {

constexpr int kMaxPeople = 256;  // of the simulator

struct BenchArguments {
  DemoArguments demo;
  UsersBenchOptions options;
};

int RunBench(service::ServiceCommandLine& line, BenchArguments& arguments) {
  if (arguments.options.first > arguments.options.max) {
    return line.Fail(
        {ErrorCode::kInvalidArgument, fmt::format("--first must be at most --max ({}), is {}",
                                                  arguments.options.max, arguments.options.first)});
  }
  if (const Status complete = Complete(line, arguments.demo); !complete) {
    return line.Fail(complete.error());
  }
  arguments.options.demo = arguments.demo.options;
  const auto report = BenchUsers(arguments.options);
  if (!report) {
    return line.Fail(report.error());
  }
  if (const Status written = WriteJson(arguments.demo, *report); !written) {
    return line.Fail(written.error());
  }
  return (*report)["largest"].get<int>() > 0 ? 0 : 1;
}

}  // namespace

SubCommand AddBenchCommand(service::ServiceCommandLine& line) {
  const auto arguments = std::make_shared<BenchArguments>();
  UsersBenchOptions& options = arguments->options;
  CLI::App* bench = line.app().add_subcommand("bench", "Measure what this host carries");
  bench->require_subcommand(1);
  CLI::App* users =
      bench->add_subcommand("users",
                            "The largest number of simulated people (15 sensors, 100 Hz) without a "
                            "lost sample, with the\n"
                            "latency sensor to client in bounds; cost and memory of each person by "
                            "process. Real processes\n"
                            "on this host. Exit status 1: not even one person.\n"
                            "Examples:\n"
                            "  limbcast bench users --dds cyclone --json users.json\n"
                            "  limbcast bench users --dds fast --people 5,10,20 --seconds 30");
  users->add_option("--seconds", options.seconds, "Measured in each run")
      ->check(CLI::Range(1.0, 3600.0));
  users->add_option("--p99-ms", options.limits.p99_ms, "Limit of the 99th percentile")
      ->check(CLI::Range(0.1, 10'000.0));
  users->add_option("--first", options.first, "Number of people to begin with")
      ->check(CLI::Range(1, kMaxPeople));
  users->add_option("--max", options.max, "Largest number of people to try")
      ->check(CLI::Range(1, kMaxPeople));
  users->add_option("--attempts", options.attempts, "Runs before a number counts as too many")
      ->check(CLI::Range(1, 20));
  users->add_option("--people", options.people, "These numbers and no search")
      ->delimiter(',')
      ->check(CLI::Range(1, kMaxPeople));
  AddDemoOptions(*users, arguments->demo);
  return {.app = bench, .run = [&line, arguments] { return RunBench(line, *arguments); }};
}

}  // namespace limbcast::tool
