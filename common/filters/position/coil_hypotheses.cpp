#include "common/filters/position/coil_hypotheses.hpp"

#include <algorithm>
#include <cmath>

namespace limbcast::filters {

CoilHypotheses::CoilHypotheses(const CoilInertialFilter& fresh, bool has_half_space)
    : fresh_(fresh),
      filters_{fresh, fresh},
      has_half_space_(has_half_space),
      decided_(has_half_space) {}

Result<CoilHypotheses> CoilHypotheses::Make(const CoilInertialConfig& config) {
  auto fresh = CoilInertialFilter::Make(config);
  if (!fresh) {
    return fresh.error();
  }
  return CoilHypotheses(*fresh, config.half_space.has_value());
}

CoilUpdateReport CoilHypotheses::Update(const sensing::CoilFrame& frame) {
  std::array<CoilUpdateReport, 2> reports;
  reports[better_] = filters_[better_].Update(frame);
  if (decided_) {
    if (filter().phase() == CoilPhase::kLevelling && !has_half_space_) {
      decided_ = false;  // it had to begin anew: nothing is known of the side
    }
    return reports[better_];
  }
  if (two_) {
    const std::size_t other = 1 - better_;
    reports[other] = filters_[other].Update(frame);
    Compare(frame, reports);
    CoilUpdateReport report = reports[better_];
    report.acquired = decided_ && filter().phase() == CoilPhase::kTracking;
    return report;
  }
  if (reports[better_].acquired) {
    filters_[1 - better_] = filters_[better_];
    filters_[1 - better_].Mirror();
    two_ = true;
    sums_ = {};
  }
  reports[better_].acquired = false;
  return reports[better_];
}

void CoilHypotheses::Compare(const sensing::CoilFrame& frame,
                             const std::array<CoilUpdateReport, 2>& reports) {
  const auto gone = [&](std::size_t i) {
    return reports[i].lost || filters_[i].phase() != CoilPhase::kTracking;
  };
  if (gone(0) && gone(1)) {
    filters_ = {fresh_, fresh_};
    two_ = false;
    better_ = 0;
    return;
  }
  if (gone(0) || gone(1)) {
    Decide(gone(0) ? 1 : 0);
    return;
  }
  if (frame.drive.coil < 0 || !frame.drive.settled) {
    return;
  }
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    sums_[i] += std::min(reports[i].nis, kMostOfOne);
  }
  better_ = sums_[1] < sums_[0] ? 1 : 0;
  if (std::abs(sums_[1] - sums_[0]) > kDecidedBy) {
    Decide(better_);
  }
}

void CoilHypotheses::Decide(std::size_t which) {
  better_ = which;
  decided_ = true;
  two_ = false;
}

}  // namespace limbcast::filters
