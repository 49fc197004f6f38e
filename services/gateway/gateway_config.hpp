#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/base/ids.hpp"
#include "common/base/result.hpp"
#include "common/config/config_file.hpp"
#include "services/gateway/stream_clock.hpp"

namespace limbcast::gateway {

/// Which service must answer link probes before the first sample is sent.
enum class WaitFor : std::uint8_t { kNone, kFusion, kPosture };

/// What the gateway does with its driver's data. Section [gateway]; keys as the fields, except
/// where said.
struct GatewayConfig {
  /// "simulator" or "replay"; each has a section of its own.
  std::string driver = "simulator";

  /// Key `speed`: a factor, or "max" for as fast as the pipeline takes it without losing a sample.
  Pace pace;

  /// Begin again at the end; time and sequence numbers go on. Recordings only.
  bool loop = false;

  /// End the process when the data ends; else stay and say so in `health`.
  bool exit_at_end = false;

  /// Folder with the sensors' calibrations (`limbcast calibrate sensor --out`); their readings are
  /// corrected before they are published. Empty: raw readings. At most 1024 characters.
  std::string calibration_folder;

  /// All sensors of a body in one message (topic marg_frame) instead of one for each (marg).
  /// Cheaper for many people.
  bool marg_frame = false;

  /// Number of this gateway in its frames, for a body whose sensors are on two gateways.
  std::uint32_t gateway_id = 0;

  /// Publish who wears what. With `session_host` that host does, whatever this says.
  bool publish_roster = true;

  /// Join `session` through a session host, which gives the body ids and writes the roster. Nothing
  /// is sent before it has.
  bool session_host = false;

  /// Name of the driver's person in place of the driver's own; several are numbered ("NAME 2"). At
  /// most 60 characters.
  std::string person;

  /// Publish what the driver knows of the truth.
  bool publish_truth = true;

  /// Name of the session in the roster; with `session_host` also its partition. At most 64
  /// characters.
  std::string session;

  /// Number of the driver's first body; the others follow. 0: as the driver has them.
  std::uint32_t body_id = 0;

  /// Body ids that a session host gave, one for each of the driver's bodies; not in files. Empty:
  /// `body_id` decides.
  std::vector<BodyId> granted_bodies;

  /// With "fusion" or "posture", nothing is sent until the way to that service is open. As fast as
  /// possible implies fusion.
  WaitFor wait_for = WaitFor::kNone;

  /// Longest wait, and what then. Keys `wait_timeout_s` [0.1, 3600] and `wait_timeout_action`
  /// ("continue" or "exit").
  double wait_timeout_s = 30.0;
  bool exit_on_wait_timeout = false;

  /// As fast as possible: ticks that may be under way unanswered. More is quicker; above the depth
  /// of the streams (bus.stream_depth, 16) samples get lost. Range: [1, 1024].
  std::size_t window_ticks = 8;

  /// A sample unanswered for this long counts as lost, and the gateway goes on. Range: [0.01, 60].
  double answer_timeout_s = 2.0;

  /// After the last sample, the process stays this long, so that what was sent arrives. Range:
  /// [0, 60].
  double linger_s = 0.3;
};

/// Reads [gateway]; refusals are remembered in the section's file.
[[nodiscard]] GatewayConfig ReadGatewayConfig(const config::Section& section,
                                              GatewayConfig defaults = {});

[[nodiscard]] Status Validate(const GatewayConfig& config);

}  // namespace limbcast::gateway
