#include "tools/limbcast/bench_command.hpp"

#include <memory>

#include "tools/limbcast/bench/churn_bench.hpp"
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

struct ChurnArguments {
  DemoArguments demo;
  ChurnOptions options;
};

int RunChurn(service::ServiceCommandLine& line, ChurnArguments& arguments) {
  if (const Status complete = Complete(line, arguments.demo); !complete) {
    return line.Fail(complete.error());
  }
  ChurnOptions& options = arguments.options;
  options.dds = arguments.demo.options.dds;
  options.bus = arguments.demo.options.bus;
  options.folder = arguments.demo.options.folder;
  const auto report = BenchChurn(options);
  if (!report) {
    return line.Fail(report.error());
  }
  if (const Status written = WriteJson(arguments.demo, *report); !written) {
    return line.Fail(written.error());
  }
  return (*report)["ok"].get<bool>() ? 0 : 1;
}

// Fills the sub-command `churn` of `bench`.
void AddChurn(CLI::App& churn, ChurnArguments& arguments) {
  ChurnOptions& options = arguments.options;
  churn.add_option("--minutes", options.minutes, "How long")->check(CLI::Range(0.1, 10'000.0));
  churn.add_option("--count-every", options.count_every_s, "Seconds between two counts")
      ->check(CLI::Range(5.0, 3600.0));
  churn.add_option("--action-every", options.action_every_s, "Mean seconds between two events")
      ->check(CLI::Range(0.05, 60.0));
  churn.add_option("--people", options.people, "Who come and go")->check(CLI::Range(1, 32));
  churn.add_option("--seed", options.seed, "Of who does what when");
  churn
      .add_option("--rss-mib", options.limits.rss_mib,
                  "A process may hold so much more than at first")
      ->check(CLI::Range(0.0, 10'000.0));
  AddNetworkOfDemo(churn, arguments.demo);
}

CLI::App* AddUsers(CLI::App& bench, BenchArguments& arguments) {
  UsersBenchOptions& options = arguments.options;
  CLI::App* users =
      bench.add_subcommand("users",
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
  AddDemoOptions(*users, arguments.demo);
  return users;
}

}  // namespace

SubCommand AddBenchCommand(service::ServiceCommandLine& line) {
  const auto arguments = std::make_shared<BenchArguments>();
  const auto churn_arguments = std::make_shared<ChurnArguments>();
  CLI::App* bench = line.app().add_subcommand("bench", "Measure what this host carries");
  bench->require_subcommand(1);
  const CLI::App* const users = AddUsers(*bench, *arguments);
  AddChurn(
      *bench->add_subcommand(
          "churn",
          "People who join, leave and vanish at random and services that are killed at random; "
          "every minute\n"
          "everybody comes in and goes home, and what the processes then still hold is counted: "
          "threads, open files,\n"
          "memory, shared memory, bodies. Real processes on this host. Exit status 1: something "
          "leaked or failed.\n"
          "Examples:\n"
          "  limbcast bench churn --dds mixed --minutes 10\n"
          "  limbcast bench churn --people 8 --action-every 0.3 --json churn.json"),
      *churn_arguments);
  return {.app = bench, .run = [&line, users, arguments, churn_arguments] {
            return users->parsed() ? RunBench(line, *arguments) : RunChurn(line, *churn_arguments);
          }};
}

}  // namespace limbcast::tool
