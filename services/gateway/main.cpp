#include <spdlog/spdlog.h>

#include <atomic>
#include <cstdlib>
#include <memory>
#include <utility>

#include "common/bus/bus_factory.hpp"
#include "common/runtime/stop_signal.hpp"
#include "common/runtime/system_clock.hpp"
#include "common/runtime/thread_pool.hpp"
#include "common/service/bus_events.hpp"
#include "common/service/health_publisher.hpp"
#include "services/gateway/calibrated_driver.hpp"
#include "services/gateway/coil_pulse_driver.hpp"
#include "services/gateway/driver_factory.hpp"
#include "services/gateway/gateway_command_line.hpp"
#include "services/gateway/gateway_config.hpp"
#include "services/gateway/gateway_service.hpp"
#include "services/gateway/gateway_session.hpp"

int main(int argc, char** argv) {
  using namespace limbcast;
  gateway::GatewayCommandLine command;
  if (const auto status = command.Parse(argc, argv)) return *status;
  const Result<config::ConfigFile> file = command.LoadSettings();
  if (!file) return command.Fail(file.error());
  gateway::GatewayConfig config = gateway::ReadGatewayConfig(file->Get("gateway"));
  const gateway::DriverConfigs drivers = gateway::ReadDriverConfigs(*file);
  Result<bus::BusConfig> bus_config = command.ReadBus(*file);
  if (const Status read = file->Finish(); !read) return command.Fail(read.error());
  if (!bus_config) return command.Fail(bus_config.error());
  if (const Status valid = gateway::Validate(config); !valid) return command.Fail(valid.error());
  Result<std::unique_ptr<gateway::Driver>> driver = gateway::MakeDriver(config.driver, drivers);
  if (!driver) return command.Fail(driver.error());
  command.StartLog();

  runtime::StopSignal stop_signal;  // SIGINT, SIGTERM, and the end of the data
  const runtime::SystemClock clock;
  runtime::ThreadPool worker("gateway", 1);
  service::BusEvents events;
  if (config.session_host) bus_config->partition = config.session;
  const Result<std::unique_ptr<bus::Bus>> bus = bus::Open(*bus_config, events.handler());
  if (!bus) return command.Fail(bus.error());

  auto calibrated = gateway::WithCoilPulses(
      gateway::WithCalibrations(std::move(*driver), config.calibration_folder));
  const auto session = gateway::GatewaySession::Make(**bus, config, calibrated->Describe());
  if (!session) return command.Fail(session.error());
  std::unique_ptr<gateway::GatewayService> service;
  std::atomic<bool> started{false};  // the service
  const auto health =
      service::HealthPublisher::Make("gateway", clock, **bus, [&](ServiceHealth& report) {
        (*session)->FillHealth(report);
        if (started) service->FillHealth(report);
        events.Report(report);
      });
  if (!health) return command.Fail(health.error());
  spdlog::info("on {}; driver {}", (*bus)->Describe(), config.driver);
  (*health)->Start();
  if (!(*session)->Wait([&] { return stop_signal.Requested(); })) return EXIT_SUCCESS;
  config.granted_bodies = (*session)->bodies();

  service = std::make_unique<gateway::GatewayService>(config, std::move(calibrated), clock, **bus,
                                                      worker, [&] { stop_signal.Trigger(); });
  if (const Status status = service->Start(); !status) return command.Fail(status.error());
  started = true;
  stop_signal.Wait();
  (*health)->Stop();
  service->Stop();
  const gateway::GatewaySummary summary = service->Summary();
  spdlog::info("{}", gateway::ToText(summary));
  command.PrintSummary(summary);
  const Status result = service->result();
  return result ? EXIT_SUCCESS : command.Fail(result.error());
}
