#include "common/simulation/marker_model.hpp"

#include <cmath>
#include <utility>

#include "common/base/expects.hpp"
#include "common/base/range.hpp"

namespace limbcast::simulation {

Status Validate(const MarkerErrors& errors) {
  return CheckRanges("markers: ", {{"sigma_m", errors.sigma_m, 0.0, 0.1},
                                   {"gap_rate_hz", errors.gap_rate_hz, 0.0, 100.0},
                                   {"gap_s", errors.gap_s, 0.0, 100.0},
                                   {"ghost_rate", errors.ghost_rate, 0.0, 1.0},
                                   {"ghost_distance_m", errors.ghost_distance_m, 1e-6, 10.0},
                                   {"swap_rate_hz", errors.swap_rate_hz, 0.0, 100.0},
                                   {"swap_s", errors.swap_s, 0.0, 100.0}});
}

MarkerModel::MarkerModel(const MarkerErrors& errors, std::size_t markers, const Random& random)
    : errors_(errors), random_(random), hidden_s_(markers, 0.0), seen_(markers) {
  Expects(Validate(errors).ok(), "validated marker errors");
}

bool MarkerModel::Begins(double rate_hz, double dt_s) {
  return rate_hz > 0.0 && random_.Uniform(0.0, 1.0) < -std::expm1(-rate_hz * dt_s);
}

std::span<const SeenMarker> MarkerModel::See(std::span<const Eigen::Vector3d> p_earth_m,
                                             double dt_s) {
  Expects(p_earth_m.size() == seen_.size(), "a place for each marker");
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    SeenMarker& seen = seen_[i];
    seen.p_earth_marker_m = p_earth_m[i] + errors_.sigma_m * random_.Gaussian3();
    if (errors_.ghost_rate > 0.0 && random_.Uniform(0.0, 1.0) < errors_.ghost_rate) {
      seen.p_earth_marker_m = p_earth_m[i] + random_.Uniform3(errors_.ghost_distance_m);
    }
    hidden_s_[i] -= dt_s;
    if (hidden_s_[i] <= 0.0 && Begins(errors_.gap_rate_hz, dt_s)) {
      hidden_s_[i] = errors_.gap_s;
    }
    seen.visible = hidden_s_[i] <= 0.0;
  }
  swapped_s_ -= dt_s;
  if (seen_.size() >= 2) {
    if (swapped_s_ <= 0.0 && Begins(errors_.swap_rate_hz, dt_s)) {
      swapped_s_ = errors_.swap_s;
      swapped_ = static_cast<std::size_t>(random_.Next() % (seen_.size() - 1));
    }
    if (swapped_s_ > 0.0) {
      std::swap(seen_[swapped_], seen_[swapped_ + 1]);
    }
  }
  return seen_;
}

}  // namespace limbcast::simulation
