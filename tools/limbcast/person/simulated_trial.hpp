#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/body/forward_kinematics.hpp"
#include "common/simulation/marg_model.hpp"
#include "common/simulation/motion_schedule.hpp"
#include "tools/limbcast/person/body_bench.hpp"

namespace limbcast::tool {

/// A simulated person with sensors turned arbitrarily on body::SixteenSegments().
struct SimulatedPersonOptions {
  simulation::MotionSchedule schedule;
  double facing_rad = 0.0;
  double duration_s = 300.0;
  double rate_hz = 100.0;
  std::uint64_t seed = 20240517;
  bool magnetometer = true;
  simulation::NoisePreset noise = simulation::NoisePreset::kDefault;
};

/// N-pose, then walking both ways, sitting and turning for ever: what acceptance asks for.
[[nodiscard]] simulation::MotionSchedule MakeCalibrationSchedule();

/// Errors of one run, over windows of time.
struct TruthErrors {
  double from_s = 0.0;
  double to_s = 0.0;
  double segment_rms_rad = 0.0;   ///< of all tracked segments, in the earth frame
  double relative_rms_rad = 0.0;  ///< ... after the pelvis' heading error is taken out of all
  double joint_rms_rad = 0.0;     ///< of the angle between neighbours that both carry a sensor
  body::PerSegment<double> worst_rms_rad{};  ///< relative, of each segment
};

struct SimulatedTrace {
  std::vector<std::string> events;
  bool calibrated = false;
  std::vector<TruthErrors> windows;
};

/// Runs the person through fusion and posture, sample by sample, and compares with the truth in
/// windows of `window_s` from `compare_from_s` on. Nothing is recorded: half an hour fits.
[[nodiscard]] Result<SimulatedTrace> RunSimulatedTrial(const SimulatedPersonOptions& person,
                                                       const BodyTrialOptions& options,
                                                       double compare_from_s, double window_s);

}  // namespace limbcast::tool
