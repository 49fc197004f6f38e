#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/base/health.hpp"
#include "common/base/result.hpp"
#include "common/client/session_member.hpp"
#include "services/gateway/driver.hpp"
#include "services/gateway/gateway_config.hpp"

namespace limbcast::gateway {

/// The gateway's people in a session, when a session host is configured; else nothing, and nothing
/// is waited for. The host writes the roster; it knows from here who wears what, and that the
/// gateway is alive. Thread-safe.
class GatewaySession {
 public:
  /// Asks at once. `bus` is in the partition of the session and outlives this. Fails when the bus
  /// does, or with kInvalidArgument when the driver says of no sensor where it is worn.
  [[nodiscard]] static Result<std::unique_ptr<GatewaySession>> Make(
      bus::Bus& bus, const GatewayConfig& config, const DriverDescription& description);

  /// Waits until the host has accepted everybody; false when `stop` says so before. What stands in
  /// the way is logged and in health.
  [[nodiscard]] bool Wait(const std::function<bool()>& stop);

  /// The body ids that the host gave, in the order of the driver's bodies; none without a host.
  [[nodiscard]] std::vector<BodyId> bodies() const;

  /// Sets last_error while somebody is not in the session.
  void FillHealth(ServiceHealth& health) const;

 private:
  GatewaySession() = default;
  [[nodiscard]] std::string Trouble() const;

  std::string session_;
  std::vector<std::string> people_;
  std::unique_ptr<client::SessionMember> member_;  // null: no session host
};

}  // namespace limbcast::gateway
