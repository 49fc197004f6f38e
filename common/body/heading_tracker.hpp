#pragma once

#include <Eigen/Geometry>
#include <array>

#include "common/body/forward_kinematics.hpp"
#include "common/body/segment.hpp"

namespace limbcast::body {

/// How fast headings are drawn together. Slow, so that nobody sees it, and bounded.
struct HeadingTrackerConfig {
  /// Time of walking in which a wrong heading of a trunk or leg segment falls to 1/e. Range: [1,
  /// 600].
  double time_constant_s = 15.0;

  /// ... in which what was observed of an arm comes into force. Range: [1, 600].
  double arm_time_constant_s = 5.0;

  /// A heading that has to be taken back again and again drifts at a rate; that rate is learned
  /// over this time and taken back at all times. Range: [30, 36000].
  double rate_time_s = 300.0;

  /// No heading is turned faster than this. Range: (0, 1].
  double max_rate_rad_s = 0.03;
};

/// Keeps the headings of sensors without magnetometer from drifting apart. While a person walks,
/// each segment of trunk and legs faces the way the trunk faces on the average of strides, a shank
/// the way its thigh does, since the knee is a hinge. What
/// differs is drift, and is taken back slowly. Arms hang as they like; what their movement says
/// (FindWalkingDirections) comes in by Observe. Standing, sitting and turning on the spot correct
/// nothing: there a turned thigh is a turned thigh.
///
/// That mean headings of neighbouring segments agree over many strides is what the field calls
/// "stay aligned" (field.md 5.1, ask 1). The heading of the body as a whole stays free: nothing in
/// a magnetometer-free set observes it.
///
/// One call costs less than a microsecond; no allocation. Thread-compatible.
class HeadingTracker {
 public:
  explicit HeadingTracker(const HeadingTrackerConfig& config = {}) : config_(config) {}

  /// One tick. `dt_s` ≥ 0 since the one before; more than 0.1 s counts as a new start.
  /// @param use  segments measured in this tick and aligned.
  /// @return  by how much to turn each segment about earth z; zero unless it is in `use`.
  const PerSegment<double>& Update(double dt_s, const PerSegment<bool>& use,
                                   const PerSegment<Eigen::Quaterniond>& q_earth_segment);

  /// True while the last ticks look like walking.
  [[nodiscard]] bool walking() const { return walking_; }

  /// A heading was seen to be wrong by `error_rad`, ± `sigma_rad`: it is taken back slowly, by a
  /// share that falls with sigma.
  void Observe(Segment segment, double error_rad, double sigma_rad);

  /// A segment was aligned anew: what was observed of it is forgotten.
  void Forget(Segment segment);
  void Reset() { *this = HeadingTracker(config_); }

 private:
  void NoteActivity(double dt_s, const PerSegment<bool>& use,
                    const PerSegment<Eigen::Quaterniond>& q_earth_segment);

  HeadingTrackerConfig config_;
  PerSegment<Eigen::Quaterniond> last_q_{};
  PerSegment<bool> last_use_{};
  PerSegment<double> activity_rad2_s2_{};  // of the legs: mean square of the angular rate
  PerSegment<double> observed_rad_{};      // still to be taken back
  PerSegment<double> rate_rad_s_{};        // learned, by which headings are turned all the time
  double trunk_rate_rad_s_ = 0.0;          // low-passed
  double trunk_heading_rad_ = 0.0;
  bool has_last_ = false;
  bool walking_ = false;
  PerSegment<double> turn_rad_{};
};

}  // namespace limbcast::body
