#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/body/body_definition.hpp"
#include "common/body/skeleton.hpp"
#include "common/roster/command.hpp"
#include "common/roster/roster.hpp"
#include "services/fusion/sensor_track.hpp"
#include "services/posture/body_tracker.hpp"
#include "services/posture/commands.hpp"

namespace limbcast::tool {

/// How sensors are turned into a person.
struct BodyTrialOptions {
  std::string filter = "bmf";
  posture::PostureConfig posture;
  /// The reference pose is taken at this time by command, as a person would; nothing: no command.
  std::optional<double> reference_pose_s;
  /// ... and a functional calibration follows, until this time.
  std::optional<double> walk_until_s;
  /// Heading of the person in the reference pose, where sensors know north.
  std::optional<double> facing_rad;
  /// Starts with this alignment (and the sensors it was made for) instead of none.
  std::optional<body::BodyDefinition> restored;
};

/// One person's sensors, each with its track of the fusion service, and the posture service's body
/// tracker behind them: the pipeline without processes and without a clock. Thread-compatible.
class BodyBench {
 public:
  using OnSkeleton = std::function<void(const body::Skeleton& skeleton)>;

  /// Fails for an unknown filter or a body that cannot be. `options` outlives it.
  [[nodiscard]] static Result<std::unique_ptr<BodyBench>> Make(
      const BodyTrialOptions& options, const std::vector<roster::SensorAssignment>& sensors,
      OnSkeleton on_skeleton);

  /// A sample of `sensing::MargSample` or `sensing::FusedOrientation`; sensors that nobody wears
  /// are passed over.
  template <typename Sample>
  void Feed(Sample sample);

  /// A tick is over: what is due is emitted, and commands of `options` are given.
  void EndTick(Time now, double time_s);

  [[nodiscard]] body::BodyDefinition Definition();
  [[nodiscard]] const std::vector<std::string>& events() const { return events_; }
  [[nodiscard]] bool calibrated() const { return calibrated_; }
  [[nodiscard]] bool aligned(std::size_t row) const {
    return tracker_->definition().segments[row].aligned;
  }

 private:
  explicit BodyBench(const BodyTrialOptions& options)
      : options_(options), commands_(options.posture) {}
  void Command(roster::CommandKind kind, std::string text, Time now);
  void Note(const std::string& what, bool good);

  const BodyTrialOptions& options_;
  posture::BodyCommands commands_;
  std::unique_ptr<posture::BodyTracker> tracker_;
  std::map<SensorUid, std::unique_ptr<fusion::SensorTrack>> tracks_;
  std::map<SensorUid, std::uint32_t> sequence_;
  std::vector<std::string> events_;
  double time_s_ = 0.0;
  bool posed_ = false;
  bool walked_ = false;
  bool calibrated_ = false;
};

}  // namespace limbcast::tool
