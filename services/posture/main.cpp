#include <spdlog/spdlog.h>

#include <cstdlib>

#include "common/bus/bus_factory.hpp"
#include "common/runtime/stop_signal.hpp"
#include "common/runtime/system_clock.hpp"
#include "common/runtime/thread_pool.hpp"
#include "common/service/bus_events.hpp"
#include "common/service/health_publisher.hpp"
#include "common/service/service_command_line.hpp"
#include "services/posture/posture_config.hpp"
#include "services/posture/posture_service.hpp"

namespace {

constexpr const char* kExamples =
    "  limbcast-posture                                 one host, Cyclone DDS, 23 segments\n"
    "  limbcast-posture --config deploy/config/posture.toml --dds fast --domain 7\n"
    "  limbcast-posture --set posture.output_rate_hz=90 --set posture.body_height_m=1.82";

}  // namespace

int main(int argc, char** argv) {
  using namespace limbcast;
  service::ServiceCommandLine command("limbcast-posture",
                                      "Turns segment orientations into skeletons.", kExamples);
  if (const auto status = command.Parse(argc, argv)) return *status;
  const Result<config::ConfigFile> file = command.LoadConfig();
  if (!file) return command.Fail(file.error());
  const posture::PostureConfig config = posture::ReadPostureConfig(file->Get("posture"));
  const Result<bus::BusConfig> bus_config = command.ReadBus(*file);
  if (const Status read = file->Finish(); !read) return command.Fail(read.error());
  if (!bus_config) return command.Fail(bus_config.error());
  command.StartLog();

  const runtime::StopSignal stop_signal;  // SIGINT, SIGTERM
  const runtime::SystemClock clock;
  runtime::ThreadPool workers("posture", config.workers);
  service::BusEvents events;
  const Result<std::unique_ptr<bus::Bus>> bus = bus::Open(*bus_config, events.handler());
  if (!bus) return command.Fail(bus.error());

  posture::PostureService service(config, clock, **bus, workers);
  if (const Status started = service.Start(); !started) return command.Fail(started.error());
  const auto health =
      service::HealthPublisher::Make("posture", clock, **bus, [&](ServiceHealth& h) {
        service.FillHealth(h);
        events.Report(h);
      });
  if (!health) return command.Fail(health.error());
  spdlog::info("on {}; {} workers, deadline {} s", (*bus)->Describe(), config.workers,
               config.tick_deadline_s);
  (*health)->Start();
  stop_signal.Wait();
  (*health)->Stop();
  service.Stop();
  return EXIT_SUCCESS;
}
