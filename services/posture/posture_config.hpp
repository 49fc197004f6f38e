#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/body/default_body.hpp"
#include "common/body/segment.hpp"
#include "common/config/config_file.hpp"

namespace limbcast::posture {

/// What the posture service can be told, table [posture] of its file.
struct PostureConfig {
  /// Threads that compute; bodies are shared out among them. Range: [1, 64].
  std::uint32_t workers = 1;

  /// A skeleton is emitted at the latest this long after the first state of its tick arrived,
  /// however many segments are still to come. Range: [0.0005, 1].
  double tick_deadline_s = 0.008;

  /// Skeletons a second, each predicted to the instant it is emitted. 0: one for each tick of the
  /// sensors, as soon as it is complete. Range: 0 or [1, 1000].
  double output_rate_hz = 0.0;

  /// A segment whose measurement is older than the skeleton is turned on with its last angular
  /// rate, but not for longer than this. Range: [0, 1].
  double max_extrapolation_s = 0.05;

  /// A sensor silent for this long is missing: no longer waited for, its segment is filled from its
  /// neighbours. Range: [0.05, 600].
  double missing_after_s = 2.0;

  /// The reference pose is the mean over this long before the command. Range: [0.05, 2].
  double still_window_s = 0.3;

  /// The reference pose is refused when a sensor turned by more than this within the window. Range:
  /// (0, 1].
  double still_limit_rad = 0.06;

  /// Height of a person until a command says otherwise. Range: [0.5, 2.5].
  double body_height_m = body::kDefaultBodyHeight_m;

  /// Segments of the skeleton by name; the pelvis is always there. Empty: all 23.
  std::vector<body::Segment> segments;

  /// Brings hips, knees, ankles, elbows and wrists softly back to where they can bend.
  bool joint_limits = false;

  /// The most by which a limit is overstepped. Range: [0.001, 1].
  double joint_softness_rad = 0.1;

  /// Finds out which feet are on the ground and lets the person walk over it; needs legs with
  /// aligned sensors. False: the root stays at standing height but for position fixes.
  bool contacts = true;

  /// Publishes joint angles beside the skeletons, to whoever reads the topic; while nobody does
  /// they cost nothing.
  bool joint_angles = true;

  /// A new alignment takes this long to come into force, so that nothing jumps; only what was
  /// aligned before. Range: [0, 5].
  double blend_s = 0.4;

  /// Calibrates a body by itself: as soon as it has stood still and then walked 15 s. A body whose
  /// alignment was restored only has its headings set, when it stands upright and still (sensors
  /// without magnetometer).
  bool automatic_calibration = false;

  /// Keeps headings of sensors without magnetometer together while the person walks.
  bool heading_tracking = true;

  /// Positions that fusion publishes take part: of a sensor of an arm or a leg against the one that
  /// carries the coils, and of the pelvis by its marker. Needs aligned sensors.
  bool positions = true;

  /// Table `sensor_places`: where the sensor sits on its segment, three numbers from the inboard
  /// end in segment axes; else in the middle, on the skin. Range: ±0.5.
  std::map<body::Segment, Eigen::Vector3d> sensor_places_m;

  /// Folder in which alignment and dimensions of each body survive a restart. Empty: they do not.
  std::string state_dir;
};

[[nodiscard]] Status Validate(const PostureConfig& config);

/// Reads the table; refusals are remembered in its file (ConfigFile::Finish).
[[nodiscard]] PostureConfig ReadPostureConfig(const config::Section& section);

}  // namespace limbcast::posture
