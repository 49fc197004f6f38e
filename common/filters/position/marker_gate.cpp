#include "common/filters/position/marker_gate.hpp"

#include <algorithm>
#include <cmath>

namespace limbcast::filters {

MarkerVerdict MarkerGate::Push(const sensing::MarkerPosition& sample) {
  if (has_last_ && sample.measured_at <= last_.at) {
    return MarkerVerdict::kOutOfOrder;
  }
  if (!sample.visible || !sample.p_earth_marker_m.allFinite()) {
    return MarkerVerdict::kHidden;
  }
  const TimedMarker marker{sample.measured_at, sample.p_earth_marker_m,
                           std::max(0.0, static_cast<double>(sample.sigma_m))};
  repeats_ = has_last_ && marker.p_earth_marker_m == last_.p_earth_marker_m ? repeats_ + 1 : 1;
  last_ = marker;
  has_last_ = true;
  if (repeats_ >= kRepeatsAreMissing) {
    return MarkerVerdict::kRepeated;
  }
  if (tail_ - head_ == kQueue) {
    ++head_;  // nobody takes them: no inertial readings
  }
  queue_[tail_ % kQueue] = marker;
  ++tail_;
  return MarkerVerdict::kQueued;
}

std::optional<TimedMarker> MarkerGate::Take(Time until, MarkerCounters& counters) {
  std::optional<TimedMarker> newest;
  while (head_ != tail_ && queue_[head_ % kQueue].at <= until) {
    if (newest) {
      counters.Add(MarkerVerdict::kSuperseded);
    }
    newest = queue_[head_ % kQueue];
    ++head_;
  }
  return newest;
}

void OutlierRun::AddRejected(Time at, const Eigen::Vector3d& nu_m) {
  if (n_ == 0) {
    begun_at_ = at;
  }
  last_s_ = ToSeconds(at - begun_at_);
  ++n_;
  ++in_a_row_;
  sum_t_ += last_s_;
  sum_tt_ += last_s_ * last_s_;
  sum_nu_ += nu_m;
  sum_tnu_ += last_s_ * nu_m;
  sum_nunu_ += nu_m.squaredNorm();
}

double OutlierRun::RmsAboutLine_m() const {
  // Residual of the least-squares line ν(t) = ν̄ + b (t − t̄), all three axes.
  const double n = n_;
  const double var_t = sum_tt_ - sum_t_ * sum_t_ / n;
  if (n_ < 3 || !(var_t > 0.0)) {
    return 0.0;
  }
  const Eigen::Vector3d cov_tnu = sum_tnu_ - sum_t_ / n * sum_nu_;
  const double rest = sum_nunu_ - sum_nu_.squaredNorm() / n - cov_tnu.squaredNorm() / var_t;
  return std::sqrt(std::max(0.0, rest) / n);
}

bool OutlierRun::foreign() const {
  return last_s_ > kForeignAfter_s && !in_doubt() && RmsAboutLine_m() > kForeignRms_m;
}

}  // namespace limbcast::filters
