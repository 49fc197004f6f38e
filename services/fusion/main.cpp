#include <spdlog/spdlog.h>

#include <cstdlib>

#include "common/bus/bus_factory.hpp"
#include "common/runtime/stop_signal.hpp"
#include "common/runtime/system_clock.hpp"
#include "common/runtime/thread_pool.hpp"
#include "common/service/bus_events.hpp"
#include "common/service/health_publisher.hpp"
#include "common/service/service_command_line.hpp"
#include "services/fusion/fusion_config.hpp"
#include "services/fusion/fusion_service.hpp"

namespace {

constexpr const char* kExamples =
    "  limbcast-fusion                                  one host, Cyclone DDS, default filter\n"
    "  limbcast-fusion --config deploy/config/fusion.toml --dds fast --domain 7\n"
    "  limbcast-fusion --set fusion.workers=4 --set filter.name=tqt --set filter.beside=bmf";

}  // namespace

int main(int argc, char** argv) {
  using namespace limbcast;
  service::ServiceCommandLine command("limbcast-fusion",
                                      "Turns sensor samples into segment orientations.", kExamples);
  if (const auto status = command.Parse(argc, argv)) return *status;
  const Result<config::ConfigFile> file = command.LoadConfig();
  if (!file) return command.Fail(file.error());
  const fusion::FusionConfig config = fusion::ReadFusionConfig(*file);
  const Result<bus::BusConfig> bus_config = command.ReadBus(*file);
  if (const Status read = file->Finish(); !read) return command.Fail(read.error());
  if (!bus_config) return command.Fail(bus_config.error());
  const Status valid = fusion::Validate(config, fusion::MakeFilterFactory(config));
  if (!valid) return command.Fail(valid.error());
  command.StartLog();

  const runtime::StopSignal stop_signal;  // SIGINT, SIGTERM
  const runtime::SystemClock clock;
  runtime::ThreadPool workers("fusion", config.workers);
  service::BusEvents events;
  const Result<std::unique_ptr<bus::Bus>> bus = bus::Open(*bus_config, events.handler());
  if (!bus) return command.Fail(bus.error());

  fusion::FusionService service(config, clock, **bus, workers);
  if (const Status started = service.Start(); !started) return command.Fail(started.error());
  const auto health = service::HealthPublisher::Make("fusion", clock, **bus, [&](ServiceHealth& h) {
    service.FillHealth(h);
    events.Report(h);
  });
  if (!health) return command.Fail(health.error());
  spdlog::info("on {}; {} workers, filter {}", (*bus)->Describe(), config.workers,
               config.filter.name);
  (*health)->Start();
  stop_signal.Wait();
  service.Stop();
  (*health)->Stop();  // the last word, with everything counted
  return EXIT_SUCCESS;
}
