#pragma once

#include "common/base/time.hpp"
#include "common/base/verdict.hpp"
#include "common/filters/position/inertial_mechanisation.hpp"
#include "common/sensing/marg_sample.hpp"

namespace limbcast::filters {

/// An inertial reading after the bad-input rules of position filters.
struct GatedInertial {
  SampleVerdict verdict = SampleVerdict::kNoData;  ///< kFused, kPredictedOnly (held) or why not
  InertialReading reading;
  double dt_s = 0.0;          ///< since the last reading that was passed on; 0 for the first
  bool first = false;         ///< nothing before it
  bool long_dropout = false;  ///< more than 50 ms without readings lie before it
  double noise_factor = 1.0;  ///< on standard deviations over the step to this reading

  [[nodiscard]] bool usable() const { return IsUsed(verdict); }
};

/// Bad-input rules for inertial readings (design/position.md section 13): a dropout up to 50 ms is
/// held at the last reading with ten times the noise, a longer one is reported; saturation gives
/// thirty times the noise; time that goes back or stands still drops the sample. Thread-compatible.
class InertialGate {
 public:
  static constexpr double kMaxHold_s = 0.05;
  static constexpr double kHoldNoise = 10.0;
  static constexpr double kSaturationNoise = 30.0;
  static constexpr double kSaturatedAt = 0.98;

  /// @param accel_range_m_s2, gyro_range_rad_s  full scales, 0 = unknown.
  InertialGate(double accel_range_m_s2, double gyro_range_rad_s)
      : accel_range_m_s2_(accel_range_m_s2), gyro_range_rad_s_(gyro_range_rad_s) {}

  [[nodiscard]] GatedInertial Pass(const sensing::MargSample& sample);

 private:
  [[nodiscard]] bool Saturated(const sensing::MargSample& sample,
                               const InertialReading& reading) const;

  double accel_range_m_s2_;
  double gyro_range_rad_s_;
  bool has_time_ = false;
  Time last_passed_at_{};
  Time last_good_at_{};
  InertialReading last_;
  double nominal_dt_s_ = 0.0;
  bool was_saturated_ = false;
};

}  // namespace limbcast::filters
