#pragma once

#include <cstdint>

#include "common/base/result.hpp"
#include "common/filters/position/coil_inertial_filter.hpp"

namespace limbcast::filters {

/// A start without a configured half space: concentric coils have the same field at p and −p, so
/// two filters begin, one on each side, and the motion decides (design/position.md section 9): the
/// inertial acceleration has the opposite sign in one of them. The one with the smaller sum of
/// magnetometer NIS stays, once they are kDecisiveNis apart; after kPatience_s of tracking
/// whichever is ahead. From then on it is that filter alone; losses keep its side. At rest both are
/// the same for good: waiting begins with motion.
///
/// Allocates nothing. Thread-compatible.
class CoilBothSides {
 public:
  static constexpr double kDecisiveNis = 20.0;
  static constexpr double kPatience_s = 5.0;  ///< of motion

  /// @param config  any; its half space is not used.
  [[nodiscard]] static Result<CoilBothSides> Make(CoilInertialConfig config);

  CoilUpdateReport Update(const sensing::CoilFrame& frame);

  /// One of the two is left. Until then `filter()` may be at the mirror image of the truth.
  [[nodiscard]] bool decided() const { return decided_; }
  /// On which side the sensor is is known, and the track is not lost.
  [[nodiscard]] bool valid() const { return decided_ && filter().phase() == CoilPhase::kTracking; }
  /// The one that is ahead.
  [[nodiscard]] const CoilInertialFilter& filter() const { return upper_leads_ ? upper_ : lower_; }

 private:
  CoilBothSides(const CoilInertialFilter& upper, const CoilInertialFilter& lower)
      : upper_(upper), lower_(lower) {}
  void Decide();

  CoilInertialFilter upper_;
  CoilInertialFilter lower_;
  bool decided_ = false;
  bool upper_leads_ = true;
  double nis_ahead_ = 0.0;  // Σ NIS of the lower minus that of the upper
  double moving_s_ = 0.0;
  Time last_at_{};
  bool has_time_ = false;
};

}  // namespace limbcast::filters
