#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/roster/command.hpp"

namespace limbcast::tool {

/// What leads a person through the alignment of the sensors on the body needs of the world.
struct BodyGuide {
  /// Asks the posture service and waits for the answer.
  std::function<Result<roster::CommandReply>(roster::CommandKind kind, const std::string& text,
                                             const std::vector<double>& numbers)>
      ask;
  std::function<void(const std::string& line)> say;
  /// Lets time pass; false: the person gave up.
  std::function<bool(double seconds)> wait;
};

struct BodyGuideOptions {
  std::string pose = "n_pose";  ///< or "t_pose"
  /// Heading of the person in the reference pose, where sensors know north.
  std::optional<double> facing_rad{};  // NOLINT(readability-redundant-member-init): lets callers
                                       // name some fields only
  double countdown_s = 5.0;            ///< to get into the pose
  double walk_s = 20.0;                ///< 0: no walk, for sensors with a magnetometer
  /// Saved under this name at the end; "" = not.
  std::string profile{};  // NOLINT(readability-redundant-member-init): as above
};

/// Countdown, reference pose (again when the person moved), walk, result, profile. When the walk
/// cannot be used, the alignment that was in force before is put back. Gives what the service said
/// last; fails with its reason.
[[nodiscard]] Result<std::string> GuideBody(const BodyGuide& guide,
                                            const BodyGuideOptions& options);

}  // namespace limbcast::tool
