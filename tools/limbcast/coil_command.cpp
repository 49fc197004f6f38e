#include "tools/limbcast/coil_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "common/sensing/coil_slots.hpp"

namespace limbcast::tool {
namespace {

constexpr double kMsPerS = 1e3;
constexpr double kNtPerTesla = 1e9;

struct PlanOptions {
  double pulse_ms = 34.0;
  double clock_error_ms = 0.5;
  double rate_hz = 1.0 / 0.6;
  double free_running_hz = 0.0;
  double moment_a_m2 = 0.713;
  int users = 1;
};

int PrintPlan(const PlanOptions& options) {
  sensing::CoilSlotConfig config;
  config.pulse_s = options.pulse_ms / kMsPerS;
  config.clock_error_s = options.clock_error_ms / kMsPerS;
  config.burst_rate_hz = options.rate_hz;
  config.free_running_hz = options.free_running_hz;
  config.moment_a_m2 = options.moment_a_m2;
  if (const Status valid = sensing::Validate(config); !valid) {
    fmt::print(stderr, "limbcast coil plan: {}\n", valid.error().message);
    return 2;
  }
  const sensing::CoilSlotPlan plan = sensing::PlanCoilSlots(config);
  fmt::print("guard            {:8.1f} ms   2 x clock error + tail{}\n", kMsPerS * plan.guard_s,
             options.free_running_hz > 0.0 ? " + sampling period" : "");
  fmt::print("slot             {:8.1f} ms   {:.1f} single pulses/s\n", kMsPerS * plan.slot_s,
             plan.slots_per_s);
  fmt::print("burst            {:8.1f} ms   {:.1f} bursts/s for all within reuse distance\n",
             kMsPerS * plan.burst_s, plan.bursts_per_s);
  fmt::print("users            {:8.1f}      at {:.2f} bursts/s each; duty of a source {:.0f} %\n",
             plan.users, options.rate_hz, 100.0 * plan.duty);
  fmt::print("reuse distance   {:8.1f} m    source to foreign sensor; beyond it slots are shared\n",
             plan.reuse_distance_m);
  for (const double distance_m : {1.0, 1.5, 2.0, 3.0}) {
    fmt::print("foreign field    {:8.1f} nT   at {:.1f} m\n",
               kNtPerTesla * sensing::ForeignField_tesla(options.moment_a_m2, distance_m),
               distance_m);
  }
  const bool fits = options.users <= plan.users;
  if (fits) {
    fmt::print("{} user{} fit in one place\n", options.users, options.users == 1 ? "" : "s");
  } else {
    fmt::print(
        "{} users do not fit in one place: at most {:.2f} bursts/s each, or groups of {:.0f} more "
        "than {:.1f} m apart\n",
        options.users, plan.bursts_per_s / options.users, std::max(1.0, std::floor(plan.users)),
        plan.reuse_distance_m);
  }
  return fits ? 0 : 1;
}

}  // namespace

SubCommand AddCoilCommand(service::ServiceCommandLine& line) {
  auto options = std::make_shared<PlanOptions>();
  CLI::App* coil = line.app().add_subcommand("coil", "Body-worn magnetic sources");
  coil->require_subcommand(1);
  CLI::App* plan = coil->add_subcommand(
      "plan",
      "How many sources fit in one place. Exit status 1: these users do not.\nExample:\n  limbcast "
      "coil plan --pulse-ms 34 --clock-error-ms 0.5 --users 4");
  plan->add_option("--pulse-ms", options->pulse_ms, "Length of a pulse, both polarities");
  plan->add_option("--clock-error-ms", options->clock_error_ms, "Of any two clocks");
  plan->add_option("--rate", options->rate_hz, "Bursts a second that each user wants");
  plan->add_option("--free-running", options->free_running_hz,
                   "Rate in Hz of magnetometers that do not sample in step with the slots");
  plan->add_option("--moment", options->moment_a_m2, "Of a source, A m2");
  plan->add_option("--users", options->users, "Users in one place")->check(CLI::Range(1, 1000));
  return {.app = coil, .run = [options] { return PrintPlan(*options); }};
}

}  // namespace limbcast::tool
