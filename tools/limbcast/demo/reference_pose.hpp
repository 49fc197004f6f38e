#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "common/base/result.hpp"
#include "common/base/time.hpp"
#include "common/bus/bus.hpp"

namespace limbcast::tool {

/// Asks the posture service to take the reference pose of bodies, each again and again until it is
/// accepted. Thread-safe.
class ReferencePose {
 public:
  /// `bus` outlives it.
  [[nodiscard]] static Result<std::unique_ptr<ReferencePose>> Make(bus::Bus& bus);

  /// Sends the command for `body_id` unless it was accepted, at most every 300 ms for each body.
  void Ask(BodyId body_id, Time now);

  /// The pose of at least one body was asked for, and all that were are taken.
  [[nodiscard]] bool accepted();
  /// What the service said last; "" before its first answer.
  [[nodiscard]] std::string message();

 private:
  ReferencePose() = default;

  std::unique_ptr<bus::Writer<roster::Command>> writer_;
  std::uint64_t client_uid_ = 0;
  std::uint64_t request_id_ = 0;
  struct Asked {
    Time at{};
    bool accepted = false;
  };
  std::mutex mutex_;  // guards all below
  std::map<BodyId, Asked> bodies_;
  std::map<std::uint64_t, BodyId> requests_;  // not yet accepted
  std::string message_;
  std::unique_ptr<bus::Reader<roster::CommandReply>> reader_;
};

}  // namespace limbcast::tool
