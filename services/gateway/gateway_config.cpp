#include "services/gateway/gateway_config.hpp"

#include <array>
#include <charconv>
#include <limits>
#include <utility>

#include "common/base/range.hpp"

namespace limbcast::gateway {

namespace {

constexpr double kMinSpeed = 0.01;
constexpr double kMaxSpeed = 1000.0;
constexpr std::size_t kMaxNameLength = 64;    // bound of the wire types
constexpr std::size_t kMaxPersonLength = 60;  // leaves room for a number
constexpr std::size_t kMaxPathLength = 1024;

constexpr std::array<std::pair<std::string_view, WaitFor>, 3> kWaitForNames = {
    {{"none", WaitFor::kNone}, {"fusion", WaitFor::kFusion}, {"posture", WaitFor::kPosture}}};
constexpr std::array<std::pair<std::string_view, bool>, 2> kTimeoutActions = {
    {{"continue", false}, {"exit", true}}};

Pace ReadPace(const config::Section& section, Pace pace) {
  const std::string text = section.ReadAnyAsText("speed");
  if (text.empty()) {
    return pace;
  }
  if (text == "max") {
    pace.as_fast = true;
    return pace;
  }
  double speed = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), speed);
  if (error != std::errc{} || end != text.data() + text.size() ||
      !(speed >= kMinSpeed && speed <= kMaxSpeed)) {
    section.Fail("speed", "must be in [0.01, 1000] or \"max\", is " + text);
    return pace;
  }
  return {.speed = speed, .as_fast = false};
}

}  // namespace

GatewayConfig ReadGatewayConfig(const config::Section& section, GatewayConfig defaults) {
  GatewayConfig config = std::move(defaults);
  config.driver = section.Read("driver", config.driver, kMaxNameLength);
  config.pace = ReadPace(section, config.pace);
  config.loop = section.Read("loop", config.loop);
  config.exit_at_end = section.Read("exit_at_end", config.exit_at_end);
  config.calibration_folder =
      section.Read("calibration_folder", config.calibration_folder, kMaxPathLength);
  config.marg_frame = section.Read("marg_frame", config.marg_frame);
  constexpr auto kAnyNumber = std::numeric_limits<std::uint32_t>::max();
  config.gateway_id = section.Read("gateway_id", config.gateway_id, 0U, kAnyNumber);
  config.publish_roster = section.Read("publish_roster", config.publish_roster);
  config.session_host = section.Read("session_host", config.session_host);
  config.person = section.Read("person", config.person, kMaxPersonLength);
  config.publish_truth = section.Read("publish_truth", config.publish_truth);
  config.session = section.Read("session", config.session, kMaxNameLength);
  config.body_id = section.Read("body_id", config.body_id, 0U, kAnyNumber);
  config.wait_for = section.Read<WaitFor>("wait_for", config.wait_for, kWaitForNames);
  config.wait_timeout_s = section.Read("wait_timeout_s", config.wait_timeout_s, 0.1, 3600.0);
  config.exit_on_wait_timeout =
      section.Read<bool>("wait_timeout_action", config.exit_on_wait_timeout, kTimeoutActions);
  config.window_ticks = section.Read("window_ticks", config.window_ticks, 1U, 1024U);
  config.answer_timeout_s = section.Read("answer_timeout_s", config.answer_timeout_s, 0.01, 60.0);
  config.linger_s = section.Read("linger_s", config.linger_s, 0.0, 60.0);
  return config;
}

Status Validate(const GatewayConfig& config) {
  Status ranges = CheckRanges(
      "gateway.", {{"speed", config.pace.speed, kMinSpeed, kMaxSpeed},
                   {"wait_timeout_s", config.wait_timeout_s, 0.1, 3600.0},
                   {"window_ticks", static_cast<double>(config.window_ticks), 1.0, 1024.0},
                   {"answer_timeout_s", config.answer_timeout_s, 0.01, 60.0},
                   {"linger_s", config.linger_s, 0.0, 60.0}});
  if (!ranges) {
    return ranges;
  }
  if (config.session.size() > kMaxNameLength) {
    return Error{ErrorCode::kInvalidArgument, "gateway.session must have at most 64 characters"};
  }
  if (config.session_host && config.session.empty()) {
    return Error{ErrorCode::kInvalidArgument,
                 "gateway.session must name a session when gateway.session_host is true"};
  }
  return Ok();
}

}  // namespace limbcast::gateway
