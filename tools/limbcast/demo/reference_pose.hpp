#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "common/base/result.hpp"
#include "common/base/time.hpp"
#include "common/bus/bus.hpp"

namespace limbcast::tool {

/// Asks the posture service to take the reference pose, again and again until it accepts.
/// Thread-safe.
class ReferencePose {
 public:
  /// `bus` outlives it.
  [[nodiscard]] static Result<std::unique_ptr<ReferencePose>> Make(bus::Bus& bus);

  /// Sends the command for `body_id` when none is on its way, at most every 300 ms.
  void Ask(BodyId body_id, Time now);

  [[nodiscard]] bool accepted();
  /// What the service said last; "" before its first answer.
  [[nodiscard]] std::string message();

 private:
  ReferencePose() = default;

  std::unique_ptr<bus::Writer<roster::Command>> writer_;
  std::uint64_t client_uid_ = 0;
  std::uint64_t request_id_ = 0;
  Time asked_at_{};
  std::mutex mutex_;  // guards the two below
  bool accepted_ = false;
  std::string message_;
  std::unique_ptr<bus::Reader<roster::CommandReply>> reader_;
};

}  // namespace limbcast::tool
