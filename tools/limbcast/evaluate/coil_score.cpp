#include "tools/limbcast/evaluate/coil_score.hpp"

#include <algorithm>
#include <cmath>

#include "common/math/rotation.hpp"

namespace limbcast::tool {

void CoilScore::Add(const Eigen::Vector3d& p_emitter_m, const Eigen::Quaterniond& q_sensor_emitter,
                    const simulation::CoilTick& truth) {
  const double distance_m = p_emitter_m.norm() - truth.p_emitter_sensor_m.norm();
  const double turn_rad = math::AngleBetween_rad(q_sensor_emitter, truth.q_sensor_emitter);
  sum_.position_m += (p_emitter_m - truth.p_emitter_sensor_m).squaredNorm();
  sum_.distance_m += distance_m * distance_m;
  sum_.orientation_rad += turn_rad * turn_rad;
  ++sum_.count;
}

CoilFigure CoilScore::Figure() const {
  CoilFigure figure = sum_;
  for (double* value : {&figure.position_m, &figure.distance_m, &figure.orientation_rad}) {
    *value = std::sqrt(*value / std::max(1, figure.count));
  }
  return figure;
}

}  // namespace limbcast::tool
