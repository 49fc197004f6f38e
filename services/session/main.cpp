#include <spdlog/spdlog.h>

#include <cstdlib>

#include "common/bus/bus_factory.hpp"
#include "common/runtime/stop_signal.hpp"
#include "common/runtime/system_clock.hpp"
#include "common/runtime/thread_pool.hpp"
#include "common/service/bus_events.hpp"
#include "common/service/health_publisher.hpp"
#include "common/service/service_command_line.hpp"
#include "services/session/session_config.hpp"
#include "services/session/session_service.hpp"

namespace {

constexpr const char* kExamples =
    "  limbcast-session --set session.sessions='[\"stage\"]'     one session from the start\n"
    "  limbcast-session --config deploy/config/session.toml --dds fast --domain 7\n"
    "  limbcast-session --set session.state_dir=/var/lib/limbcast/session";

}  // namespace

int main(int argc, char** argv) {
  using namespace limbcast;
  service::ServiceCommandLine command("limbcast-session",
                                      "Hosts sessions: who takes part, who wears what.", kExamples);
  if (const auto status = command.Parse(argc, argv)) return *status;
  const Result<config::ConfigFile> file = command.LoadConfig();
  if (!file) return command.Fail(file.error());
  const session::SessionConfig config = session::ReadSessionConfig(file->Get("session"));
  const Result<bus::BusConfig> bus_config = command.ReadBus(*file);
  if (const Status read = file->Finish(); !read) return command.Fail(read.error());
  if (!bus_config) return command.Fail(bus_config.error());
  if (const Status valid = session::Validate(config); !valid) return command.Fail(valid.error());
  command.StartLog();

  const runtime::StopSignal stop_signal;  // SIGINT, SIGTERM
  const runtime::SystemClock clock;
  runtime::ThreadPool worker("session", 1);
  service::BusEvents events;
  const Result<std::unique_ptr<bus::Bus>> lobby = bus::Open(*bus_config, events.handler());
  if (!lobby) return command.Fail(lobby.error());
  const auto open_partition = [&](const std::string& partition) {
    bus::BusConfig in_session = *bus_config;
    in_session.partition = partition;
    return bus::Open(in_session, events.handler());
  };

  session::SessionService service(config, clock, **lobby, open_partition, worker);
  if (const Status started = service.Start(); !started) return command.Fail(started.error());
  const auto health =
      service::HealthPublisher::Make("session", clock, **lobby, [&](ServiceHealth& h) {
        service.FillHealth(h);
        events.Report(h);
      });
  if (!health) return command.Fail(health.error());
  spdlog::info("on {}; at most {} sessions, state in \"{}\"", (*lobby)->Describe(),
               config.limits.max_sessions, config.state_dir);
  (*health)->Start();
  stop_signal.Wait();
  (*health)->Stop();
  service.Stop();
  return EXIT_SUCCESS;
}
