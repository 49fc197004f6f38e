#include "services/gateway/gateway_command_line.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace limbcast::gateway {

namespace {

constexpr const char* kDescription =
    "Brings sensors onto the network: a simulated person, or a recording played as if it were "
    "live.";

constexpr const char* kExamples =
    "  limbcast-gateway                                   a simulated person on this host\n"
    "  limbcast-gateway --recording walk.hdf5 --loop      a recording, again and again\n"
    "  limbcast-gateway --recording trial.hdf5 --speed max --exit-at-end --summary json\n"
    "                       as fast as fusion takes it, nothing lost, then say what was done\n"
    "  limbcast-gateway --recording xsens/ --assign 00B42279=pelvis --assign 00B42268=t8\n"
    "  limbcast-gateway --set simulator.persons=4 --set gateway.marg_frame=true --dds fast\n"
    "Formats of recordings: services/gateway/drivers/replay/README.md; CSV: CSV.md beside it.";

}  // namespace

std::string TomlString(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      quoted += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

GatewayCommandLine::GatewayCommandLine()
    : ServiceCommandLine("limbcast-gateway", kDescription, kExamples) {
  app().add_option("--driver", driver_, "simulator (default) or replay")->type_name("NAME");
  app()
      .add_option("--recording", recording_,
                  "Play this: BROAD or full-body HDF5, Xsens text exports (file or folder), CSV")
      ->type_name("PATH");
  app()
      .add_option("--speed", speed_,
                  "Recording seconds in each second; max: as fast as the pipeline takes it")
      ->type_name("X|max");
  app().add_flag("--loop", loop_, "Begin again at the end of the recording");
  app().add_option("--wait-for", wait_for_,
                   "Send nothing before the way is open to: none (default), fusion, posture");
  app().add_flag("--exit-at-end", exit_at_end_, "End when the recording ends");
  app()
      .add_option("--assign", assignments_,
                  "Where a sensor of the recording is worn, e.g. 00B42279=pelvis; may be given "
                  "several times")
      ->type_name("SENSOR=SEGMENT")
      ->allow_extra_args(false);
  app().add_option("--person", person_, "Name of the person in a recording");
  app().add_option("--body-id", body_id_, "Number of the first person")->type_name("N");
  app()
      .add_option("--summary", summary_, "At the end, on stdout: none (default), text or json")
      ->check(CLI::IsMember({"none", "text", "json"}));
}

Result<config::ConfigFile> GatewayCommandLine::LoadSettings() const {
  Result<config::ConfigFile> file = LoadConfig();
  if (!file) {
    return file;
  }
  std::vector<std::string> settings;
  if (driver_ || recording_) {
    settings.push_back("gateway.driver=" + TomlString(driver_.value_or("replay")));
  }
  if (recording_) {
    settings.push_back("replay.recording=" + TomlString(*recording_));
  }
  if (speed_) {
    settings.push_back("gateway.speed=" + *speed_);
  }
  if (wait_for_) {
    settings.push_back("gateway.wait_for=" + TomlString(*wait_for_));
  }
  if (person_) {
    settings.push_back("replay.person=" + TomlString(*person_));
  }
  if (body_id_) {
    settings.push_back(fmt::format("gateway.body_id={}", *body_id_));
  }
  if (loop_) {
    settings.emplace_back("gateway.loop=true");
  }
  if (exit_at_end_) {
    settings.emplace_back("gateway.exit_at_end=true");
  }
  std::string list;
  for (const std::string& assignment : assignments_) {
    const std::size_t equals = assignment.rfind('=');
    if (equals == std::string::npos) {
      return Error{ErrorCode::kInvalidArgument,
                   "--assign must be SENSOR=SEGMENT, is \"" + assignment + "\""};
    }
    list += fmt::format("{}{{sensor={}, segment={}}}", list.empty() ? "" : ", ",
                        TomlString(assignment.substr(0, equals)),
                        TomlString(assignment.substr(equals + 1)));
  }
  if (!list.empty()) {
    settings.push_back("replay.assign=[" + list + "]");
  }
  for (const std::string& setting : settings) {
    if (const Status done = file->Override(setting); !done) {
      return done.error();
    }
  }
  return file;
}

void GatewayCommandLine::PrintSummary(const GatewaySummary& summary) const {
  if (summary_ != "none") {
    fmt::print("{}\n", summary_ == "json" ? ToJson(summary) : ToText(summary));
    std::fflush(stdout);
  }
}

}  // namespace limbcast::gateway
