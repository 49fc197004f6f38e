#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/body/alignment.hpp"
#include "common/body/body_definition.hpp"
#include "common/body/forward_kinematics.hpp"
#include "common/body/heading_tracker.hpp"
#include "common/body/root_tracker.hpp"
#include "common/body/skeleton.hpp"
#include "common/roster/roster.hpp"
#include "common/sensing/position_samples.hpp"
#include "services/posture/alignment_blend.hpp"
#include "services/posture/body_calibrator.hpp"
#include "services/posture/orientation_window.hpp"
#include "services/posture/posture_config.hpp"
#include "services/posture/state_input.hpp"
#include "services/posture/tick_assembler.hpp"

namespace limbcast::posture {

/// What became of a state that reached a body.
enum class StateFate : std::uint8_t {
  kUsed,        ///< part of a tick
  kLate,        ///< its tick had been emitted
  kIgnored,     ///< duplicate, out of order, or with a time or orientation that cannot be
  kUnassigned,  ///< the roster does not have this sensor on this segment
};

/// Why a skeleton was emitted.
enum class TickEnd : std::uint8_t {
  kComplete,   ///< every segment that is waited for was there
  kDeadline,   ///< the deadline passed first
  kOvertaken,  ///< a sensor's next sample came first
  kRate,       ///< its time at the fixed output rate had come
};

/// One person: from segment states to skeletons. Owns alignment and dimensions (the definition),
/// the last state of each sensor and the open tick. No clock, no thread, no DDS; after the first
/// tick OnState and OnDue do not allocate, except for a calibration that is wanted and, with
/// sensors without magnetometer, a survey of the arms after some seconds of walking.
/// Thread-compatible: one worker owns it.
class BodyTracker {
 public:
  /// `skeleton` is reused and lives only during the call; `live` is false while no segment has an
  /// orientation (link probes).
  using Emit = std::function<void(body::Skeleton& skeleton, TickEnd end, bool live)>;

  /// `definition` is valid. `config` is validated and outlives this.
  BodyTracker(const PostureConfig& config, body::BodyDefinition definition, Emit emit);

  /// Takes over who is where. A segment that gets another sensor loses its alignment, as the new
  /// one sits differently. False when nothing changed.
  bool SetRoster(const roster::RosterEntry& entry);

  /// `now` is the host's clock.
  StateFate OnState(const StateInput& state, Time now);

  /// Where the body is, from outside; a finite position. Aids the root that follows from the
  /// contacts with the ground.
  void OnPositionFix(const sensing::PositionFix& fix);

  /// Emits what is due by `now`. Call when due() has come.
  void OnDue(Time now);
  [[nodiscard]] std::optional<Time> due() const;

  [[nodiscard]] const body::BodyDefinition& definition() const { return definition_; }
  /// Puts other dimensions or alignment in force; revision and time are set by the tracker.
  /// `definition` is valid and has the same segments.
  void Redefine(body::BodyDefinition definition, Time now);
  /// The same for what comes from a profile: offsets hold, headings of sensors without magnetometer
  /// are to be found again.
  void Restore(body::BodyDefinition definition, Time now);
  /// True once after every change of the definition: it is to be published.
  [[nodiscard]] bool TakeDefinitionChanged();

  /// Puts what the heading tracker has turned since into the definition. Before a definition is
  /// read to be changed.
  void FoldHeadings();

  /// What a functional calibration collects; commands start and finish it.
  [[nodiscard]] BodyCalibrator& calibrator() { return calibrator_; }
  [[nodiscard]] SegmentSet tracked() const { return tick_.expected(); }
  /// The newest instant of the stream.
  [[nodiscard]] Time measured_at() const { return tick_.measured_at(); }
  /// What the automatic calibration did, once after it did something.
  [[nodiscard]] std::optional<std::string> TakeCalibrated();

  /// For reference poses and heading resets.
  struct SensorView {
    bool started = false;  ///< has an orientation that is not too old
    Eigen::Quaterniond q_earth_sensor = Eigen::Quaterniond::Identity();  ///< the last one
    std::optional<body::OrientationAverage> average;                     ///< over the still window
  };
  [[nodiscard]] SensorView View(body::Segment segment) const;

  [[nodiscard]] std::uint32_t timeline_restarts() const { return timeline_restarts_; }

 private:
  struct Track {
    explicit Track(Duration window_span) : window(window_span) {}
    StateInput last;       // means something once `started`
    bool started = false;  // an orientation has been received of this sensor
    bool aligned = false;  // as in the definition
    body::SensorAlignment alignment;
    OrientationWindow window;
    AlignmentBlend blend;
    double turned_rad = 0.0;  // by the heading tracker, not yet in the definition
  };

  void Rebuild();
  void Emit_(TickEnd end, Time at);
  void PoseSegments(Time at, SegmentSet measured, SegmentSet missing);
  void UsePositions(Time at);
  void FillSkeleton(Time at, SegmentSet measured, SegmentSet missing);
  void NoteHeading(SegmentSet measured);
  void StartBlends(std::vector<Track>& before);
  void TrackHeadings(SegmentSet measured, Time at);
  void CalibrateAutomatically(Time now);
  void ChooseAutomatic(bool restored);
  [[nodiscard]] bool StandsUpright(const body::StandingPose& pose) const;

  /// What the automatic calibration waits for.
  enum class Automatic : std::uint8_t { kNothing, kStanceAndWalk, kStance };

  const PostureConfig& config_;
  const Emit emit_;
  body::BodyDefinition definition_;
  bool definition_changed_ = true;
  body::ForwardKinematics kinematics_;
  std::vector<Track> tracks_;  // by Index(segment)
  TickAssembler tick_;
  body::BodyPose pose_;
  body::Skeleton skeleton_;
  body::StageTimes completed_by_;  // of the newest arrival
  SegmentSet measured_since_output_ = 0;
  body::RootTracker root_;
  body::PerSegment<body::SegmentMotion> motion_{};       // as of the skeleton in work
  body::PerSegment<Eigen::Vector3d> sensor_places_m_{};  // p_segment_sensor
  body::PerSegment<float> sigmas_rad_{};                 // of one axis
  std::optional<Time> next_output_at_;  // fixed rate only, once something was heard
  Time shown_at_{};                     // of the last skeleton
  Time heard_at_{};                     // host clock, of the newest arrival
  std::uint32_t timeline_restarts_ = 0;
  BodyCalibrator calibrator_;
  body::HeadingTracker headings_;
  body::PerSegment<bool> headings_use_{};
  std::optional<Time> headings_at_;
  double walked_s_ = 0.0;  // on end
  Automatic automatic_ = Automatic::kNothing;
  std::optional<std::string> calibrated_;
};

}  // namespace limbcast::posture
