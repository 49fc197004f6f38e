#include "tools/limbcast/run/all_in_one.hpp"

#include <utility>

#include "services/gateway/calibrated_driver.hpp"
#include "services/gateway/coil_pulse_driver.hpp"

namespace limbcast::tool {

Result<AllInOneConfig> ReadAllInOne(const config::ConfigFile& file) {
  AllInOneConfig config;
  config.gateway = gateway::ReadGatewayConfig(file.Get("gateway"));
  config.drivers = gateway::ReadDriverConfigs(file);
  config.fusion = fusion::ReadFusionConfig(file);
  config.posture = posture::ReadPostureConfig(file.Get("posture"));
  if (const Status valid = gateway::Validate(config.gateway); !valid) {
    return valid.error();
  }
  if (const Status valid =
          fusion::Validate(config.fusion, fusion::MakeFilterFactory(config.fusion));
      !valid) {
    return valid.error();
  }
  if (const Status valid = posture::Validate(config.posture); !valid) {
    return valid.error();
  }
  return config;
}

Result<std::unique_ptr<AllInOne>> AllInOne::Make(const AllInOneConfig& config, const Clock& clock,
                                                 bus::Bus& bus, service::BusEvents* events,
                                                 std::function<void()> on_end) {
  auto driver = gateway::MakeDriver(config.gateway.driver, config.drivers);
  if (!driver) {
    return driver.error();
  }
  std::unique_ptr<AllInOne> made(new AllInOne);
  made->gateway_pool_ = std::make_unique<runtime::ThreadPool>("gateway", 1);
  made->fusion_pool_ = std::make_unique<runtime::ThreadPool>("fusion", config.fusion.workers);
  made->posture_pool_ = std::make_unique<runtime::ThreadPool>("posture", config.posture.workers);
  made->posture_ =
      std::make_unique<posture::PostureService>(config.posture, clock, bus, *made->posture_pool_);
  made->fusion_ =
      std::make_unique<fusion::FusionService>(config.fusion, clock, bus, *made->fusion_pool_);
  made->gateway_ = std::make_unique<gateway::GatewayService>(
      config.gateway,
      gateway::WithCoilPulses(
          gateway::WithCalibrations(std::move(*driver), config.gateway.calibration_folder)),
      clock, bus, *made->gateway_pool_, std::move(on_end));

  const auto report = [&](const char* role, service::HealthPublisher::Fill fill,
                          std::unique_ptr<service::HealthPublisher>& publisher) -> Status {
    auto health = service::HealthPublisher::Make(role, clock, bus, std::move(fill));
    if (!health) {
      return health.error();
    }
    publisher = std::move(*health);
    return Ok();
  };
  AllInOne& self = *made;
  Status done = report(
      "posture", [&self](ServiceHealth& h) { self.posture_->FillHealth(h); }, self.posture_health_);
  if (done) {
    done = report(
        "fusion", [&self](ServiceHealth& h) { self.fusion_->FillHealth(h); }, self.fusion_health_);
  }
  if (done) {
    done = report(
        "gateway",
        [&self, events](ServiceHealth& h) {
          self.gateway_->FillHealth(h);
          if (events != nullptr) {
            events->Report(h);
          }
        },
        self.gateway_health_);
  }
  if (!done) {
    return done.error();
  }
  return made;
}

Status AllInOne::Start() {
  if (Status started = posture_->Start(); !started) {
    return started;
  }
  if (Status started = fusion_->Start(); !started) {
    return started;
  }
  if (Status started = gateway_->Start(); !started) {
    return started;
  }
  posture_health_->Start();
  fusion_health_->Start();
  gateway_health_->Start();
  return Ok();
}

void AllInOne::Stop() {
  // Each one reports what it has done once it has done it all.
  const auto stop = [](auto& service, auto& health) {
    if (service) {
      service->Stop();
    }
    if (health) {
      health->Stop();
    }
  };
  stop(gateway_, gateway_health_);
  stop(fusion_, fusion_health_);
  stop(posture_, posture_health_);
}

}  // namespace limbcast::tool
