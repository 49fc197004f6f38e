#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/base/time.hpp"
#include "common/roster/command.hpp"
#include "services/posture/body_tracker.hpp"
#include "services/posture/posture_config.hpp"

namespace limbcast::posture {

/// What became of a command.
struct CommandOutcome {
  bool accepted = false;
  std::string message;  ///< what was done, or why not; at most 255 characters
  bool changes = true;  ///< when accepted: the definition is another one now
};

/// True for the kinds that the posture service answers.
[[nodiscard]] bool IsForPosture(roster::CommandKind kind);

/// Carries out the commands of one body and remembers how to take them back. Thread-compatible.
///
///  - kReferencePose: `text` "n_pose" (default) or "t_pose"; `numbers` none or {facing_rad}, the
///    heading of the person in the earth frame, counter-clockwise from +x. Without it: the heading
///    of the pelvis where that is aligned already, else 0. Aligns every expected segment or none.
///  - kResetHeading: `text` "body" (default: all segments turn together by the pelvis' heading) or
///    "segments" (each by its own: a person without magnetometers stands straight, and headings
///    that drifted apart come together); `numbers` none or {heading_rad} to have afterwards.
///  - kFunctionalCalibration: `text` "start" after a reference pose, "finish" after the walk, or
///    "cancel"; see BodyCalibrator. Finish aligns what the walk supports, or nothing.
///  - kResetMounting: as kReferencePose in the N-pose for the segment that `text` names (default:
///    all), for a strap that slipped; the others, and the heading of the body, stay.
///  - kSetDimensions: `text` "height" or a segment, `numbers` {metres} (body::SetDimension).
///  - kUndo: puts the definition before the last accepted command back, up to kMaxUndo times.
class BodyCommands {
 public:
  explicit BodyCommands(const PostureConfig& config) : config_(config) {}

  [[nodiscard]] CommandOutcome Execute(const roster::Command& command, Time now,
                                       BodyTracker& tracker);

  /// Puts a definition in force that comes from elsewhere (a profile), so that it can be undone.
  void Adopt(body::BodyDefinition definition, Time now, BodyTracker& tracker);

  static constexpr std::size_t kMaxUndo = 8;

 private:
  void Remember(const body::BodyDefinition& definition);
  CommandOutcome TakeReferencePose(const roster::Command& command, BodyTracker& tracker,
                                   body::BodyDefinition& definition) const;
  CommandOutcome ResetMounting(const roster::Command& command, const BodyTracker& tracker,
                               body::BodyDefinition& definition) const;
  CommandOutcome Calibrate(const roster::Command& command, BodyTracker& tracker,
                           body::BodyDefinition& definition) const;
  [[nodiscard]] std::string WhyNotStill(const BodyTracker& tracker,
                                        const body::BodyDefinition& definition,
                                        std::optional<body::Segment> only) const;
  CommandOutcome ResetHeading(const roster::Command& command, const BodyTracker& tracker,
                              body::BodyDefinition& definition) const;
  CommandOutcome Undo(const BodyTracker& tracker, body::BodyDefinition& definition);

  const PostureConfig& config_;
  std::vector<body::BodyDefinition> before_;
};

}  // namespace limbcast::posture
