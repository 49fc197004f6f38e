#include "common/filters/position/coil_hemisphere.hpp"

#include <cmath>

namespace limbcast::filters {

Hemisphere HemisphereOf(const HemisphereRule& rule, const Eigen::Vector3d& p_emitter_m) {
  if (rule.predicted_emitter_m) {
    return p_emitter_m.dot(*rule.predicted_emitter_m) >= 0.0 ? Hemisphere::kAsGiven
                                                             : Hemisphere::kOpposite;
  }
  if (!rule.half_space) {
    return Hemisphere::kUndecided;
  }
  const double sine = p_emitter_m.dot(*rule.half_space) / p_emitter_m.norm();
  if (!(std::abs(sine) >= std::sin(rule.boundary_rad))) {
    return Hemisphere::kUndecided;
  }
  return sine > 0.0 ? Hemisphere::kAsGiven : Hemisphere::kOpposite;
}

}  // namespace limbcast::filters
