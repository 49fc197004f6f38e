#pragma once

#include <Eigen/Geometry>

#include "common/simulation/coil_stream.hpp"

namespace limbcast::tool {

/// RMS errors of one method over one trial.
struct CoilFigure {
  int count = 0;
  double position_m = 0.0;  ///< 3-D, emitter axes
  double distance_m = 0.0;  ///< of |p|
  double orientation_rad = 0.0;
};

/// Adds up the errors of estimates. Thread-compatible.
class CoilScore {
 public:
  void Add(const Eigen::Vector3d& p_emitter_m, const Eigen::Quaterniond& q_sensor_emitter,
           const simulation::CoilTick& truth);
  [[nodiscard]] CoilFigure Figure() const;

 private:
  CoilFigure sum_;  // of squares
};

}  // namespace limbcast::tool
