#include "services/session/session_config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "services/session/session_names.hpp"

namespace limbcast::session {
namespace {

constexpr std::size_t kMaxPathLength = 1024;
constexpr double kMaxSlots = 1000.0;

}  // namespace

SessionConfig ReadSessionConfig(const config::Section& section, SessionConfig defaults) {
  SessionConfig config = std::move(defaults);
  RegistryLimits& limits = config.limits;
  limits.max_sessions = section.Read("max_sessions", limits.max_sessions, 1U, 100U);
  limits.max_members = section.Read("max_members", limits.max_members, 1U, 4096U);
  limits.max_members_of_client =
      section.Read("max_members_of_client", limits.max_members_of_client, 1U, 4096U);
  limits.max_remembered = section.Read("max_remembered", limits.max_remembered, 0U, 65536U);
  limits.lease = DurationFromSeconds(section.Read("lease_s", ToSeconds(limits.lease), 1.0, 60.0));
  limits.grace =
      DurationFromSeconds(section.Read("grace_s", ToSeconds(limits.grace), 0.0, 86400.0));
  limits.new_members_per_s = section.Read("new_members_per_s", limits.new_members_per_s, 1.0, 1e5);
  const config::Section coil = section.Get("coil");
  config.coil.pulse_s = coil.Read("pulse_s", config.coil.pulse_s, 0.001, 1.0);
  config.coil.clock_error_s = coil.Read("clock_error_s", config.coil.clock_error_s, 0.0, 0.1);
  config.coil.free_running_hz = coil.Read("free_running_hz", config.coil.free_running_hz, 0.0, 1e5);
  config.coil.burst_rate_hz = coil.Read("burst_rate_hz", config.coil.burst_rate_hz, 0.01, 100.0);
  limits.coil_slots = static_cast<std::uint32_t>(
      std::min(kMaxSlots, std::floor(sensing::PlanCoilSlots(config.coil).users)));
  // Three pulses in each burst, one in each frame.
  limits.coil_frame_us =
      static_cast<std::uint32_t>(std::lround(1e6 / (3.0 * config.coil.burst_rate_hz)));
  config.state_dir = section.Read("state_dir", config.state_dir, kMaxPathLength);
  config.sessions = section.Read("sessions", config.sessions);
  for (const std::string& name : config.sessions) {
    if (const Status valid = ValidateSessionName(name); !valid) {
      section.Fail("sessions", fmt::format("has \"{}\": {}", name, valid.error().message));
    }
  }
  config.allow_create = section.Read("allow_create", config.allow_create);
  config.max_refusals_per_s =
      section.Read("max_refusals_per_s", config.max_refusals_per_s, 1U, 10000U);
  return config;
}

Status Validate(const SessionConfig& config) {
  if (Status limits = Validate(config.limits); !limits) {
    return limits;
  }
  if (Status coil = sensing::Validate(config.coil); !coil) {
    return coil;
  }
  if (config.sessions.size() > config.limits.max_sessions) {
    return Error{ErrorCode::kInvalidArgument,
                 fmt::format("session.sessions must be at most session.max_sessions = {}, is {}",
                             config.limits.max_sessions, config.sessions.size())};
  }
  return Ok();
}

}  // namespace limbcast::session
