#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "common/simulation/coil_stream.hpp"

namespace limbcast::tool {

/// One of the experiments of Roetenberg 2006, sections 5.3 and 6.3, with what was printed of it
/// (tables 5.1 and 6.1; position is "the shortest distance between the coordinates").
struct CoilExperiment {
  std::string name;
  simulation::MotionFunction sensor;
  simulation::MotionFunction emitter;
  bool emitter_inertial = true;
  Eigen::Vector3d half_space = Eigen::Vector3d::UnitZ();  ///< of the emitter, where the sensor is
  double duration_s = 0.0;
  double walk_background_tesla_rts = 0.1e-6;  ///< for the filter: gradient times speed
  double published_magnetic_mm = 0.0;
  double published_magnetic_deg = 0.0;
  double published_fused_mm = 0.0;
  double published_fused_deg = 0.0;
};

/// Bench (a sensor in a hand, 10 to 80 cm from a fixed source, turned about all axes), back
/// (flexion, latero-flexion, rotation, walking), arm (flexion, abduction, walking) and leg
/// (walking); source on the pelvis. Motions of the body are those of simulation::PersonMotion;
/// latero-flexion, which it does not have, is two joints of the back.
[[nodiscard]] std::vector<CoilExperiment> MakeCoilExperiments(std::uint64_t seed);

}  // namespace limbcast::tool
