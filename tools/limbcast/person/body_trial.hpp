#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/body/body_definition.hpp"
#include "common/body/forward_kinematics.hpp"
#include "common/body/joint_angles.hpp"
#include "services/gateway/drivers/replay/recording.hpp"
#include "tools/limbcast/person/body_bench.hpp"

namespace limbcast::tool {

/// One skeleton of a run.
struct BodyFrame {
  double time_s = 0.0;
  body::PerSegment<bool> known{};  ///< tracked and aligned
  body::PerSegment<Eigen::Quaterniond> q_earth_segment{};
};

/// Of a joint between two segments: one of its three angles (body::AnglesOf), and whether both
/// segments are known.
[[nodiscard]] double JointAngle_rad(const BodyFrame& frame, body::Joint joint, int which);
[[nodiscard]] bool Knows(const BodyFrame& frame, body::Joint joint);

struct BodyTrace {
  std::vector<BodyFrame> frames;
  body::BodyDefinition definition;  ///< at the end
  std::vector<std::string> events;  ///< what was calibrated when, with the service's own words
  bool calibrated = false;          ///< by itself or by command, without refusal
};

/// Runs a recording through the pipeline, sample by sample.
[[nodiscard]] Result<BodyTrace> RunBodyTrial(const gateway::Recording& recording,
                                             const BodyTrialOptions& options);

/// The same twice: once to calibrate, and from the beginning with the profile that this left, as
/// on a person's second day: headings of sensors without magnetometer are set from the stance then.
[[nodiscard]] Result<BodyTrace> RunCalibratedTrial(const gateway::Recording& recording,
                                                   BodyTrialOptions options);

}  // namespace limbcast::tool
