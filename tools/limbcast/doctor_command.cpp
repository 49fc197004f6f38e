#include "tools/limbcast/doctor_command.hpp"

#include <fmt/format.h>

#include <chrono>
#include <memory>

#include "common/bus/bus_factory.hpp"
#include "common/runtime/stop_signal.hpp"
#include "common/runtime/system_clock.hpp"
#include "common/security/credentials.hpp"
#include "tools/limbcast/doctor/announcements.hpp"
#include "tools/limbcast/doctor/bus_facts.hpp"
#include "tools/limbcast/doctor/diagnose.hpp"
#include "tools/limbcast/doctor/host_facts.hpp"
#include "tools/limbcast/doctor/peer_probe.hpp"

namespace limbcast::tool {
namespace {

struct DoctorOptions {
  double seconds = 4.0;
  bool json = false;
};

constexpr auto kPatienceWithPeers = std::chrono::milliseconds(500);

// What can be known without DDS.
void LookAtHost(DoctorFacts& facts) {
  const bus::BusConfig& config = facts.config;
  facts.host = bus::HostInterfaces();
  facts.network = bus::DescribeNetwork(config, facts.host);
  facts.stale_shared_memory = StaleSharedMemory();
  facts.receive_buffer_bytes = NumberIn("/proc/sys/net/core/rmem_max");
  for (const std::string& peer : config.peers) {
    facts.probes.push_back(ProbePeer(peer, config.domain_id, kPatienceWithPeers));
  }
  if (!config.security_dir.empty()) {
    const auto library = config.vendor == bus::Vendor::kFast ? security::Library::kFast
                                                             : security::Library::kCyclone;
    const auto validity = security::ValidityOf(config.security_dir, config.security_role, library);
    if (validity) {
      facts.credentials_left = validity->until - runtime::SystemClock().Now();
    }
  }
}

// What others tell; false when Ctrl-C ended it.
bool ListenToOthers(const DoctorOptions& options, DoctorFacts& facts) {
  const runtime::StopSignal stop;
  const bool multicast = facts.config.network != bus::NetworkProfile::kLoopback;
  AnnouncementListener announcements(facts.config.domain_id,
                                     multicast ? bus::UsedInterfaces(facts.config, facts.host)
                                               : std::vector<bus::NetworkInterface>());
  BusFacts heard;  // outlives the bus that tells it events
  const auto bus = bus::Open(facts.config, heard.handler());
  facts.participants_here = CountParticipants(facts.config.domain_id);
  if (!bus) {
    facts.refusal = bus.error().message;
    return true;
  }
  bool stopped = false;
  if (const Status listening = heard.Listen(**bus); listening) {
    stopped = stop.WaitFor(DurationFromSeconds(options.seconds));
    facts.listened_s = options.seconds;
    facts.announcements = announcements.Heard();
  } else {
    facts.refusal = listening.error().message;
  }
  heard.Fill(facts);
  heard.Leave();
  return !stopped;
}

int Doctor(const service::ServiceCommandLine& line, const DoctorOptions& options) {
  const auto file = line.LoadConfig();
  if (!file) {
    return line.Fail(file.error());
  }
  const auto config = line.ReadBus(*file);
  if (const Status read = file->Finish(); !read) {
    return line.Fail(read.error());
  }
  if (!config) {
    return line.Fail(config.error());
  }
  DoctorFacts facts;
  facts.config = *config;
  LookAtHost(facts);
  if (!ListenToOthers(options, facts)) {
    return 1;
  }
  const std::vector<Finding> findings = Diagnose(facts);
  if (options.json) {
    fmt::print("{}\n", ToJson(facts, findings).dump(2));
    return findings.empty() ? 0 : 1;
  }
  fmt::print("domain {}, {}; {} processes heard\n", facts.config.domain_id, facts.network,
             facts.processes.size());
  for (const Finding& finding : findings) {
    fmt::print("{}\n", ToText(finding));
  }
  if (findings.empty()) {
    fmt::print("nothing is wrong\n");
  }
  return findings.empty() ? 0 : 1;
}

}  // namespace

SubCommand AddDoctorCommand(service::ServiceCommandLine& line) {
  const auto options = std::make_shared<DoctorOptions>();
  CLI::App* app = line.app().add_subcommand(
      "doctor",
      "What is wrong with the network, one line for each finding and what to do. Exit status 1 "
      "when "
      "something is.\n"
      "Run it with the options of the service that is in trouble, on its host.\n"
      "Examples:\n  limbcast doctor --network wifi --peer 10.0.0.7\n"
      "  limbcast doctor --partition stage --json");
  app->add_option("--seconds", options->seconds, "How long to listen")
      ->check(CLI::Range(0.5, 600.0));
  app->add_flag("--json", options->json, "One JSON object");
  return {.app = app, .run = [&line, options] { return Doctor(line, *options); }};
}

}  // namespace limbcast::tool
