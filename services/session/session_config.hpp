#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/config/config_file.hpp"
#include "common/sensing/coil_slots.hpp"
#include "services/session/session_registry.hpp"

namespace limbcast::session {

/// What the session host does. Section [session]; keys as the fields, except where said. The limits
/// are keys of the section itself (durations in seconds: `lease_s`, `grace_s`), but for coil_slots
/// and coil_frame_us, which follow from the table [session.coil] (fields of
/// sensing::CoilSlotConfig).
struct SessionConfig {
  RegistryLimits limits;

  /// How long a pulse of a body-worn source takes and how often each is wanted: says how many
  /// sources a session can have. Keys pulse_s, clock_error_s, free_running_hz, burst_rate_hz.
  /// The default holds the gateway's two polarities of 30 ms and what settles after them.
  sensing::CoilSlotConfig coil{.pulse_s = 0.07};

  /// Folder in which sessions and people survive a restart; empty = they do not. At most 1024
  /// characters.
  std::string state_dir;

  /// Sessions that are there from the start.
  std::vector<std::string> sessions;

  /// Clients may create sessions.
  bool allow_create = true;

  /// Refusals that are answered; more in one second are only counted. Range: [1, 10000].
  std::size_t max_refusals_per_s = 500;
};

/// Reads [session]; refusals are remembered in the section's file.
[[nodiscard]] SessionConfig ReadSessionConfig(const config::Section& section,
                                              SessionConfig defaults = {});

[[nodiscard]] Status Validate(const SessionConfig& config);

}  // namespace limbcast::session
