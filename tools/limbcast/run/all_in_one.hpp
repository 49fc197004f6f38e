#pragma once

#include <functional>
#include <memory>
#include <string>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "common/bus/bus.hpp"
#include "common/config/config_file.hpp"
#include "common/runtime/thread_pool.hpp"
#include "common/service/bus_events.hpp"
#include "common/service/health_publisher.hpp"
#include "services/fusion/fusion_config.hpp"
#include "services/fusion/fusion_service.hpp"
#include "services/gateway/driver_factory.hpp"
#include "services/gateway/gateway_config.hpp"
#include "services/gateway/gateway_service.hpp"
#include "services/posture/posture_config.hpp"
#include "services/posture/posture_service.hpp"

namespace limbcast::tool {

/// The settings of all services: the tables of their files in one.
struct AllInOneConfig {
  gateway::GatewayConfig gateway;
  gateway::DriverConfigs drivers;
  fusion::FusionConfig fusion;
  posture::PostureConfig posture;
};

/// Reads and validates every table. Does not ask `file` to Finish.
[[nodiscard]] Result<AllInOneConfig> ReadAllInOne(const config::ConfigFile& file);

/// Gateway, fusion and posture on one bus in one process, each with its own threads and its own
/// health report.
class AllInOne {
 public:
  /// Opens the driver. `clock` and `bus` outlive it; `events` (may be null) outlives it and is
  /// reported with the gateway's health. `on_end` is called from a thread of the gateway when a
  /// recording has ended (and gateway.exit_at_end says so).
  [[nodiscard]] static Result<std::unique_ptr<AllInOne>> Make(const AllInOneConfig& config,
                                                              const Clock& clock, bus::Bus& bus,
                                                              service::BusEvents* events,
                                                              std::function<void()> on_end);
  ~AllInOne() { Stop(); }
  AllInOne(const AllInOne&) = delete;
  AllInOne& operator=(const AllInOne&) = delete;

  /// Starts posture, fusion, gateway, in this order, so that nothing is sent that nobody hears.
  [[nodiscard]] Status Start();
  /// In the direction of the stream. Idempotent.
  void Stop();

  [[nodiscard]] gateway::GatewaySummary Summary() const { return gateway_->Summary(); }
  [[nodiscard]] Status result() const { return gateway_->result(); }

 private:
  AllInOne() = default;

  std::unique_ptr<runtime::ThreadPool> gateway_pool_;
  std::unique_ptr<runtime::ThreadPool> fusion_pool_;
  std::unique_ptr<runtime::ThreadPool> posture_pool_;
  std::unique_ptr<posture::PostureService> posture_;
  std::unique_ptr<fusion::FusionService> fusion_;
  std::unique_ptr<gateway::GatewayService> gateway_;
  std::unique_ptr<service::HealthPublisher> posture_health_;
  std::unique_ptr<service::HealthPublisher> fusion_health_;
  std::unique_ptr<service::HealthPublisher> gateway_health_;
};

}  // namespace limbcast::tool
