#pragma once

#include <array>

#include "common/filters/position/coil_inertial_filter.hpp"

namespace limbcast::filters {

/// The magnetic + inertial filter where nobody says on which side of the source the sensor is: the
/// fields are the same at p and −p, the accelerations are not (design/position.md section 9, rule
/// 3). From the first pose on two filters run, one for each; the one whose pulses disagree with
/// inertia goes. While neither can be told from the other, nothing is valid.
///
/// With a configured half space there is one filter, and it is believed at once. Allocates nothing.
/// Thread-compatible.
class CoilHypotheses {
 public:
  [[nodiscard]] static Result<CoilHypotheses> Make(const CoilInertialConfig& config);

  /// As CoilInertialFilter::Update of the better of the two; `acquired` when the sides were told
  /// apart, too.
  CoilUpdateReport Update(const sensing::CoilFrame& frame);

  /// The better of the two.
  [[nodiscard]] const CoilInertialFilter& filter() const { return filters_[better_]; }
  /// On which side the sensor is is known, and the track is not lost.
  [[nodiscard]] bool valid() const { return decided_ && filter().phase() == CoilPhase::kTracking; }
  [[nodiscard]] bool decided() const { return decided_; }

 private:
  /// Difference of summed NIS that decides.
  static constexpr double kDecidedBy = 20.0;
  /// Of one sample: one outlier is no decision.
  static constexpr double kMostOfOne = 16.0;

  CoilHypotheses(const CoilInertialFilter& fresh, bool has_half_space);
  void Compare(const sensing::CoilFrame& frame, const std::array<CoilUpdateReport, 2>& reports);
  void Decide(std::size_t which);

  CoilInertialFilter fresh_;
  std::array<CoilInertialFilter, 2> filters_;
  bool has_half_space_;
  bool decided_;
  bool two_ = false;
  std::size_t better_ = 0;
  std::array<double, 2> sums_{};
};

}  // namespace limbcast::filters
