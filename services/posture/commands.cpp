#include "services/posture/commands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "common/body/alignment.hpp"
#include "common/body/default_body.hpp"
#include "common/math/rotation.hpp"
#include "common/units/units.hpp"

namespace limbcast::posture {
namespace {

using body::SegmentDefinition;

constexpr std::size_t kMaxMessageLength = 255;  // bound of the wire type

CommandOutcome Refused(std::string message) { return {false, std::move(message)}; }

/// "left_hand, head" or "left_hand, head, t8, l5 and 3 more".
std::string List(const std::vector<std::string>& names) {
  constexpr std::size_t kMaxNames = 6;
  const std::size_t shown = std::min(names.size(), kMaxNames);
  std::string list = fmt::format(
      "{}", fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(shown), ", "));
  if (names.size() > shown) {
    list += fmt::format(" and {} more", names.size() - shown);
  }
  return list;
}

/// The optional angle of a command; an error text when it cannot be.
Result<std::optional<double>> ReadAngle(const roster::Command& command, const char* name) {
  if (command.numbers.empty()) {
    return std::optional<double>();
  }
  constexpr double kMax_rad = 2.0 * std::numbers::pi;
  if (command.numbers.size() > 1 || !(std::abs(command.numbers[0]) <= kMax_rad)) {
    return Error{ErrorCode::kInvalidArgument,
                 fmt::format("{} must be one number in [-{:.4g}, {:.4g}] rad, got {} number(s), "
                             "first {}",
                             name, kMax_rad, kMax_rad, command.numbers.size(), command.numbers[0])};
  }
  return std::optional(command.numbers[0]);
}

body::SensorAlignment AlignmentOf(const SegmentDefinition& segment) {
  return {segment.q_sensor_segment, segment.heading_correction_rad};
}

/// How the sensor sits, from where it is while the segment is known to be `q_earth_segment`.
void Mount(const Eigen::Quaterniond& q_earth_sensor, const Eigen::Quaterniond& q_earth_segment,
           SegmentDefinition& segment) {
  body::SensorAlignment alignment = AlignmentOf(segment);
  alignment.SetFromReferencePose(q_earth_sensor, q_earth_segment);
  segment.q_sensor_segment = alignment.q_sensor_segment();
  segment.aligned = true;
  segment.alignment_quality = 1.0F;
}

std::size_t CountTracked(const body::BodyDefinition& definition) {
  return static_cast<std::size_t>(
      std::count_if(definition.segments.begin(), definition.segments.end(),
                    [](const SegmentDefinition& segment) { return segment.tracked; }));
}

}  // namespace

bool IsForPosture(roster::CommandKind kind) {
  return kind == roster::CommandKind::kReferencePose ||
         kind == roster::CommandKind::kResetHeading ||
         kind == roster::CommandKind::kSetDimensions || kind == roster::CommandKind::kUndo ||
         kind == roster::CommandKind::kFunctionalCalibration ||
         kind == roster::CommandKind::kResetMounting || kind == roster::CommandKind::kProfile;
}

CommandOutcome BodyCommands::Execute(const roster::Command& command, Time now,
                                     BodyTracker& tracker) {
  tracker.FoldHeadings();
  body::BodyDefinition definition = tracker.definition();
  CommandOutcome outcome = Refused("not a command for the posture service");
  switch (command.kind) {
    case roster::CommandKind::kReferencePose:
      outcome = TakeReferencePose(command, tracker, definition);
      break;
    case roster::CommandKind::kResetHeading:
      outcome = ResetHeading(command, tracker, definition);
      break;
    case roster::CommandKind::kSetDimensions:
      if (command.numbers.size() != 1) {
        outcome = Refused(
            fmt::format("a dimension needs 1 number in metres, got {}", command.numbers.size()));
      } else if (const Status set =
                     body::SetDimension(command.text, command.numbers[0], definition);
                 !set) {
        outcome = Refused(set.error().message);
      } else {
        outcome = {true, fmt::format("{} is {:.3f} m", command.text, command.numbers[0])};
      }
      break;
    case roster::CommandKind::kFunctionalCalibration:
      outcome = Calibrate(command, tracker, definition);
      break;
    case roster::CommandKind::kResetMounting:
      outcome = ResetMounting(command, tracker, definition);
      break;
    case roster::CommandKind::kUndo:
      outcome = Undo(tracker, definition);
      break;
    case roster::CommandKind::kSelectFilter:
    case roster::CommandKind::kCreateSession:
    case roster::CommandKind::kCloseSession:
    case roster::CommandKind::kLeaveSession:
    case roster::CommandKind::kReleasePerson:
    case roster::CommandKind::kCountSessions:
    case roster::CommandKind::kProfile:  // the worker's, which has the files
      break;
  }
  if (outcome.accepted && outcome.changes) {
    if (command.kind != roster::CommandKind::kUndo) {
      Remember(tracker.definition());
    }
    tracker.Redefine(std::move(definition), now);
  }
  outcome.message.resize(std::min(outcome.message.size(), kMaxMessageLength));
  return outcome;
}

void BodyCommands::Remember(const body::BodyDefinition& definition) {
  if (before_.size() == kMaxUndo) {
    before_.erase(before_.begin());
  }
  before_.push_back(definition);
}

void BodyCommands::Adopt(body::BodyDefinition definition, Time now, BodyTracker& tracker) {
  Remember(tracker.definition());
  tracker.Redefine(std::move(definition), now);
}

/// Empty, or why the sensors that are wanted do not say how the person stands.
std::string BodyCommands::WhyNotStill(const BodyTracker& tracker,
                                      const body::BodyDefinition& definition,
                                      std::optional<body::Segment> only) const {
  std::vector<std::string> not_started;
  std::vector<std::string> too_few;
  std::vector<std::string> moving;
  for (const SegmentDefinition& segment : definition.segments) {
    if (!segment.tracked || (only && *only != segment.segment)) {
      continue;
    }
    const BodyTracker::SensorView view = tracker.View(segment.segment);
    const std::string name(body::ToString(segment.segment));
    if (!view.started) {
      not_started.push_back(name);
    } else if (!view.average) {
      too_few.push_back(name);
    } else if (view.average->spread_rad > config_.still_limit_rad) {
      moving.push_back(
          fmt::format("{} ({:.1f} deg)", name, units::DegFromRad(view.average->spread_rad)));
    }
  }
  if (!not_started.empty()) {
    return "not started: " + List(not_started);
  }
  if (!too_few.empty()) {
    return fmt::format("less than {} s of samples: {}", config_.still_window_s / 2.0,
                       List(too_few));
  }
  if (!moving.empty()) {
    return fmt::format("moving more than {:.1f} deg within {} s: {}",
                       units::DegFromRad(config_.still_limit_rad), config_.still_window_s,
                       List(moving));
  }
  return "";
}

CommandOutcome BodyCommands::TakeReferencePose(const roster::Command& command, BodyTracker& tracker,
                                               body::BodyDefinition& definition) const {
  const auto pose = body::ParseReferencePose(command.text.empty() ? "n_pose" : command.text);
  if (!pose) {
    return Refused(fmt::format("pose must be n_pose or t_pose, is \"{}\"", command.text));
  }
  const auto given = ReadAngle(command, "facing");
  if (!given) {
    return Refused(given.error().message);
  }
  if (CountTracked(definition) == 0) {
    return Refused("no sensor is assigned to this body");
  }
  if (std::string why = WhyNotStill(tracker, definition, std::nullopt); !why.empty()) {
    return Refused(std::move(why));
  }

  const SegmentDefinition& pelvis = definition.segments.front();
  double facing_rad = given->value_or(0.0);
  if (!given->has_value() && pelvis.tracked && pelvis.aligned) {
    facing_rad =
        math::Heading_rad(AlignmentOf(pelvis).Apply(tracker.View(pelvis.segment).average->mean));
  }
  body::StandingPose stance;
  stance.pose = *pose;
  for (SegmentDefinition& segment : definition.segments) {
    if (segment.tracked) {
      const Eigen::Quaterniond q_earth_sensor = tracker.View(segment.segment).average->mean;
      stance.known[body::Index(segment.segment)] = true;
      stance.q_earth_sensor[body::Index(segment.segment)] = q_earth_sensor;
      Mount(q_earth_sensor,
            body::HeadingRotation(facing_rad) * body::ReferenceOrientation(*pose, segment.segment),
            segment);
    }
  }
  tracker.calibrator().NoteStance(stance, tracker.measured_at());
  return {true, fmt::format("aligned {} segments, {}, facing {:.1f} deg", CountTracked(definition),
                            body::ToString(*pose), units::DegFromRad(facing_rad))};
}

CommandOutcome BodyCommands::ResetMounting(const roster::Command& command,
                                           const BodyTracker& tracker,
                                           body::BodyDefinition& definition) const {
  std::optional<body::Segment> only;
  if (!command.text.empty()) {
    only = body::ParseSegment(command.text);
    const SegmentDefinition* const found = only ? body::Find(definition, *only) : nullptr;
    if (found == nullptr || !found->tracked) {
      return Refused(fmt::format("no sensor on a segment \"{}\"", command.text));
    }
  }
  if (std::string why = WhyNotStill(tracker, definition, only); !why.empty()) {
    return Refused(std::move(why));
  }
  const SegmentDefinition& pelvis = definition.segments.front();
  const BodyTracker::SensorView pelvis_view = tracker.View(pelvis.segment);
  if (!pelvis.aligned || !pelvis_view.started) {
    return Refused("the pelvis is not aligned: take a reference pose");
  }
  const double facing_rad =
      math::Heading_rad(AlignmentOf(pelvis).Apply(pelvis_view.q_earth_sensor));
  std::size_t count = 0;
  for (SegmentDefinition& segment : definition.segments) {
    if (!segment.tracked || (only && *only != segment.segment)) {
      continue;
    }
    Mount(tracker.View(segment.segment).average->mean, body::HeadingRotation(facing_rad), segment);
    ++count;
  }
  return {true, fmt::format("mounting of {} segment(s) taken anew", count)};
}

CommandOutcome BodyCommands::Calibrate(const roster::Command& command, BodyTracker& tracker,
                                       body::BodyDefinition& definition) const {
  BodyCalibrator& calibrator = tracker.calibrator();
  if (command.text == "start") {
    if (const Status started = calibrator.Start(tracker.measured_at()); !started) {
      return Refused(started.error().message);
    }
    return {
        .accepted = true, .message = "walk now, straight on as far as possible", .changes = false};
  }
  if (command.text == "cancel") {
    calibrator.Cancel();
    return {.accepted = true, .message = "calibration given up", .changes = false};
  }
  if (command.text != "finish") {
    return Refused(
        fmt::format("calibration must be start, finish or cancel, is \"{}\"", command.text));
  }
  const auto outcome =
      calibrator.Finish(tracker.tracked(), 0.0, definition.heading != HeadingReference::kArbitrary);
  if (!outcome) {
    return Refused(outcome.error().message);
  }
  return {true, ApplyFit(*outcome, definition)};
}

CommandOutcome BodyCommands::ResetHeading(const roster::Command& command,
                                          const BodyTracker& tracker,
                                          body::BodyDefinition& definition) const {
  const bool each = command.text == "segments";
  if (!each && !command.text.empty() && command.text != "body") {
    return Refused(fmt::format("what to reset must be body or segments, is \"{}\"", command.text));
  }
  const auto given = ReadAngle(command, "heading");
  if (!given) {
    return Refused(given.error().message);
  }
  const double wanted_rad = given->value_or(0.0);
  const auto heading_rad = [&](const SegmentDefinition& segment) {
    return math::Heading_rad(
        AlignmentOf(segment).Apply(tracker.View(segment.segment).q_earth_sensor));
  };
  std::vector<std::string> not_started;
  for (const SegmentDefinition& segment : definition.segments) {
    const bool needed = each ? segment.tracked : segment.segment == body::Segment::kPelvis;
    if (needed && (!segment.tracked || !tracker.View(segment.segment).started)) {
      not_started.emplace_back(body::ToString(segment.segment));
    }
  }
  if (!not_started.empty()) {
    return Refused("not started: " + List(not_started));
  }
  const double body_turn_rad = wanted_rad - heading_rad(definition.segments.front());
  for (SegmentDefinition& segment : definition.segments) {
    if (segment.tracked) {
      body::SensorAlignment alignment = AlignmentOf(segment);
      alignment.TurnHeading(each ? wanted_rad - heading_rad(segment) : body_turn_rad);
      segment.heading_correction_rad = alignment.heading_correction_rad();
    }
  }
  return {true, fmt::format("heading of {} is {:.1f} deg now", each ? "every segment" : "the body",
                            units::DegFromRad(wanted_rad))};
}

CommandOutcome BodyCommands::Undo(const BodyTracker& tracker, body::BodyDefinition& definition) {
  if (before_.empty()) {
    return Refused("nothing to undo");
  }
  const body::BodyDefinition last = std::move(before_.back());
  before_.pop_back();
  // Who is where is the roster's; an offset goes back only to the sensor it was taken for.
  for (std::size_t i = 0; i < definition.segments.size(); ++i) {
    SegmentDefinition& segment = definition.segments[i];
    const SegmentDefinition& old = last.segments[i];
    body::TakeDimensions(old, segment);
    if (old.sensor_uid == segment.sensor_uid) {
      body::TakeAlignment(old, segment);
    }
  }
  return {true, fmt::format("took revision {} back, {} step(s) left", tracker.definition().revision,
                            before_.size())};
}

}  // namespace limbcast::posture
