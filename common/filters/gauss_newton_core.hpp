#pragma once

#include "common/filters/filter_constants.hpp"
#include "common/filters/gauss_newton_config.hpp"
#include "common/filters/gauss_newton_kernel.hpp"
#include "common/filters/rest_kernel.hpp"

namespace limbcast::filters {

/// What the tracker knows of one sensor, or of as many as T has lanes (lanes.hpp). Nothing but T,
/// flags too. Earth frame: ENU.
template <typename T>
struct GaussNewtonState {
  using Vector = kernel::Vector<T>;

  kernel::Quaternion<T> q_ES;
  Vector w_ES_S_rad_s;       // last rate, null removed
  Vector free_accel_E_m_s2;  // gravity removed
  Vector null_rad_s;         // of the gyro
  Vector null_sum_rad_s;     // over the rest so far
  T null_count;
  T null_known;  // flag
  kernel::Rest<T> rest;
  T field_north, field_up;    // reference field n, unit
  T inverse_field_per_tesla;  // 1 / |m| at start
  T has_field;                // flag
  T field_mean_square;        // of the deviation, see FieldMonitor
  T var_tilt_rad2;
  T var_heading_rad2;
};

/// One reading after the sample gate. Nothing but T, flags too. A vector whose flag is not set is
/// any finite number.
template <typename T>
struct GaussNewtonInput {
  using Vector = kernel::Vector<T>;

  T present;  // flag: there is a reading; 0 leaves a lane of a batch as it is
  T dt_s;
  T unseen_rad2;      // variance that the attitude gains beyond the gyro's noise
  Vector gyro_rad_s;  // measured, held or zero
  Vector accel_m_s2;
  Vector mag_tesla;
  T gyro_measured;  // flag: a reading of this sample
  T gyro_usable;    // flag: a reading, or the last one held
  T accel_valid;    // flag
  T use_field;      // flag: mag_tesla counts
};

/// The mathematics of GaussNewtonOrientation (equations there), apart from start and bad input.
/// `T` is double or float, or a pack of them: then every lane gets bit for bit what the number
/// gets.
namespace gauss_newton {

// The publications use 0.1–1 with the gyros of 2000. Leave-one-out over the twelve public BROAD
// trials picks 0.015–0.03 for a calibrated gyro of today; 0.04 stays on the side of a worse one.
inline constexpr double kGainWithNull_per_s = 0.04;
inline constexpr double kGainWithoutNull_per_s = 0.3;
inline constexpr double kEulerBelow_rad = 0.02;
inline constexpr double kFullGain_per_s = 1e3;   // more than any rate: one reading is everything
inline constexpr int kMeasurementOnlySteps = 3;  // suffice from the previous estimate

// Densities behind the equivalent covariance: sway of the measured vectors on a moving limb, and
// what the gyro adds. With k = 0.04 they settle at 1.6° per tilt axis and 3° of heading.
inline constexpr double kTiltNoise_rad2_s = 0.038;
inline constexpr double kHeadingNoise_rad2_s = 0.137;
inline constexpr double kGyroNoise_rad2_s = 1e-6;
inline constexpr double kMostVariance_rad2 = 3.3;  // uniform over a turn: π²/3

/// Rest, and the gyro null that the first long one gives.
template <typename T>
inline void CalibrateNull(const GaussNewtonConfig& config, const GaussNewtonInput<T>& in,
                          GaussNewtonState<T>& s) {
  const lanes::MaskOf<T> both(
      lanes::Both(lanes::IsSet(in.gyro_measured), lanes::IsSet(in.accel_valid)));
  if (lanes::All(both)) {
    kernel::UpdateRest(in.gyro_rad_s, in.accel_m_s2, s.null_rad_s, in.dt_s, s.rest);
  } else {
    kernel::Rest<T> seen = s.rest;
    kernel::UpdateRest(in.gyro_rad_s, in.accel_m_s2, s.null_rad_s, in.dt_s, seen);
    s.rest.low_gyro_rad_s = Select<T>(both, seen.low_gyro_rad_s, s.rest.low_gyro_rad_s);
    s.rest.low_accel_m_s2 = Select<T>(both, seen.low_accel_m_s2, s.rest.low_accel_m_s2);
    s.rest.started = lanes::Select(both, seen.started, s.rest.started);
    s.rest.still_s = lanes::Select(both, seen.still_s, T(0));
  }
  if (config.null_time_s == 0.0 || lanes::All(lanes::IsSet(s.null_known))) {
    return;
  }
  const lanes::MaskOf<T> learning(!lanes::IsSet(s.null_known));
  const lanes::MaskOf<T> still(s.rest.still_s > T(0));
  const kernel::Vector<T> zero{T(0), T(0), T(0)};
  const kernel::Vector<T> sum = Select<T>(still, s.null_sum_rad_s + in.gyro_rad_s, zero);
  const T count = lanes::Select(still, T(s.null_count + T(1)), T(0));
  s.null_sum_rad_s = Select<T>(learning, sum, s.null_sum_rad_s);
  s.null_count = lanes::Select(learning, count, s.null_count);
  const lanes::MaskOf<T> done(
      lanes::Both(learning, lanes::Both(still, s.rest.still_s >= T(config.null_time_s))));
  if (lanes::Any(done)) {
    const kernel::Vector<T> mean{sum.x / count, sum.y / count, sum.z / count};
    s.null_rad_s = Select<T>(done, mean, s.null_rad_s);
    s.null_known = lanes::Select(done, T(1), s.null_known);
  }
}

/// q ⊗ Exp(ω dt), or the Euler step of the publications, normalised. Exp is left as long as
/// rounding makes it: the step on gravity and field that follows brings it back.
template <typename T>
[[nodiscard]] inline kernel::Quaternion<T> Integrated(const GaussNewtonConfig& config,
                                                      const kernel::Quaternion<T>& q,
                                                      const kernel::Vector<T>& angle_rad) {
  const bool can_euler = config.integration != RateIntegration::kExponential;
  const bool can_exponential = config.integration != RateIntegration::kEuler;
  const lanes::MaskOf<T> fast(kernel::Dot(angle_rad, angle_rad) >
                              T(kEulerBelow_rad * kEulerBelow_rad));
  const lanes::MaskOf<T> exponential =
      can_euler && can_exponential ? fast : lanes::MaskOf<T>(can_exponential);
  if (lanes::All(exponential)) {
    return kernel::Rotated(q, angle_rad);
  }
  const auto euler = kernel::TimesOnePlus(q, kernel::Scaled(angle_rad, T(0.5)));
  if (!lanes::Any(exponential)) {
    return kernel::Normalised(euler);
  }
  return kernel::Normalised(Select<T>(exponential, kernel::Rotated(q, angle_rad), euler));
}

/// q + q⊗(0, α Δv) = q + (0, α R Δv)⊗q, normalised: one reduced Gauss–Newton step on up and field.
///
/// @param h0, b0  measured up and field in S, unit; b0 is zero where rho2 is.
template <typename T>
[[nodiscard]] inline kernel::Quaternion<T> Corrected(const GaussNewtonState<T>& s,
                                                     const kernel::Quaternion<T>& q,
                                                     const kernel::Vector<T>& h0,
                                                     const kernel::Vector<T>& b0, T rho2, T gain) {
  const auto step = kernel::MakeEarthStep(s.field_north, s.field_up, h0, b0, rho2, gain);
  return kernel::NormalisedOnePlusTimes(
      step.At(kernel::EastInSensor(q), kernel::NorthInSensor(q), kernel::UpInSensor(q)), q);
}

/// var ← (1 − α)² var + α² r/dt + growth: what the same gain would do to a scalar error.
template <typename T>
inline void SpreadVariance(const GaussNewtonInput<T>& in, T gain, T rate_per_s,
                           GaussNewtonState<T>& s) {
  const T growth = T(kGyroNoise_rad2_s) * in.dt_s + in.unseen_rad2;
  // α²/dt = α·k. One reading never counts for worse than the density over a tenth of a second.
  const lanes::MaskOf<T> accel_valid(lanes::IsSet(in.accel_valid));
  const T weight_per_s = lanes::Select(accel_valid, T(gain * lanes::Min(rate_per_s, T(10))), T(0));
  const T kept = lanes::Select(accel_valid, T(T(1) - gain), T(1));
  const T kept2 = kept * kept;
  const lanes::MaskOf<T> use_field(lanes::IsSet(in.use_field));
  const T kept2_heading = lanes::Select(use_field, kept2, T(1));
  const T weight_heading = lanes::Select(use_field, weight_per_s, T(0));
  s.var_tilt_rad2 =
      lanes::Min(T(kept2 * s.var_tilt_rad2 + weight_per_s * T(kTiltNoise_rad2_s) + growth),
                 T(kMostVariance_rad2));
  s.var_heading_rad2 = lanes::Min(
      T(kept2_heading * s.var_heading_rad2 + weight_heading * T(kHeadingNoise_rad2_s) + growth),
      T(kMostVariance_rad2));
}

/// What is reported besides the attitude: field deviation, rate, free acceleration.
template <typename T>
inline void Observe(const GaussNewtonInput<T>& in, GaussNewtonState<T>& s) {
  const auto up_S = kernel::UpInSensor(s.q_ES);
  const T scale = s.inverse_field_per_tesla;
  const T mean_square = kernel::MeanSquareDeviation(
      s.field_mean_square, T(scale * scale * kernel::Dot(in.mag_tesla, in.mag_tesla)),
      T(scale * kernel::Dot(up_S, in.mag_tesla)), s.field_up, in.dt_s);
  s.field_mean_square = lanes::Select(lanes::IsSet(in.use_field), mean_square, s.field_mean_square);
  const kernel::Vector<T> zero{T(0), T(0), T(0)};
  s.w_ES_S_rad_s = Select<T>(lanes::IsSet(in.gyro_usable), in.gyro_rad_s - s.null_rad_s, zero);
  const kernel::Vector<T> accel_E{kernel::Dot(kernel::EastInSensor(s.q_ES), in.accel_m_s2),
                                  kernel::Dot(kernel::NorthInSensor(s.q_ES), in.accel_m_s2),
                                  kernel::Dot(up_S, in.accel_m_s2) - T(kGravity_m_s2)};
  s.free_accel_E_m_s2 = Select<T>(lanes::IsSet(in.accel_valid), accel_E, zero);
}

/// One sample of a started tracker. `correct(q, h0, b0, rho2, gain)` is one Gauss–Newton step.
template <typename T, typename Correct>
inline void Step(const GaussNewtonConfig& config, const GaussNewtonInput<T>& in,
                 GaussNewtonState<T>& s, Correct correct) {
  CalibrateNull(config, in, s);
  const lanes::MaskOf<T> usable(lanes::IsSet(in.gyro_usable));
  const lanes::MaskOf<T> use_field(lanes::IsSet(in.use_field));
  const lanes::MaskOf<T> accel_valid(lanes::IsSet(in.accel_valid));
  kernel::Quaternion<T> q = s.q_ES;
  if (lanes::Any(usable)) {
    const auto turned =
        Integrated(config, q, kernel::Scaled(in.gyro_rad_s - s.null_rad_s, in.dt_s));
    q = lanes::All(usable) ? turned : Select<T>(usable, turned, q);
  }
  // Without a gyro, accelerometer and magnetometer alone: full gain, and more than one step.
  const T automatic =
      lanes::Select(lanes::IsSet(s.null_known), T(kGainWithNull_per_s), T(kGainWithoutNull_per_s));
  const T rate_per_s = lanes::Select(usable, config.k_per_s > 0.0 ? T(config.k_per_s) : automatic,
                                     T(kFullGain_per_s));
  const T gain = lanes::Select(usable, lanes::Min(T(rate_per_s * in.dt_s), T(1)), T(1));
  if (!lanes::All(accel_valid)) {
    q = Select<T>(accel_valid, q, kernel::Normalised(q));
  }
  if (lanes::Any(accel_valid)) {
    const kernel::Vector<T> zero{T(0), T(0), T(0)};
    const auto h0 = kernel::Scaled(
        in.accel_m_s2, T(T(1) / lanes::Sqrt(kernel::Dot(in.accel_m_s2, in.accel_m_s2))));
    const auto b0 =
        Select<T>(use_field,
                  kernel::Scaled(in.mag_tesla,
                                 T(T(1) / lanes::Sqrt(kernel::Dot(in.mag_tesla, in.mag_tesla)))),
                  zero);
    const T rho2 = lanes::Select(use_field, T(config.rho * config.rho), T(0));
    const int most = lanes::All(usable) || config.iterations > kMeasurementOnlySteps
                         ? config.iterations
                         : kMeasurementOnlySteps;
    for (int i = 0; i < most; ++i) {
      const auto corrected = correct(q, h0, b0, rho2, gain);
      const lanes::MaskOf<T> takes =
          i < config.iterations ? accel_valid : lanes::Both(accel_valid, !usable);
      q = lanes::All(takes) ? corrected : Select<T>(takes, corrected, q);
    }
  }
  s.q_ES = q;
  SpreadVariance(in, gain, rate_per_s, s);
  Observe(in, s);
}

}  // namespace gauss_newton
}  // namespace limbcast::filters
