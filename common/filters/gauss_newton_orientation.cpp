// Notation: E earth (ENU), S sensor; q_ES turns S into E. h and b are up and field in S.
#include "common/filters/gauss_newton_orientation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/filters/filter_constants.hpp"
#include "common/filters/filter_state_codec.hpp"
#include "common/filters/gauss_newton_kernel.hpp"
#include "common/filters/gauss_newton_step.hpp"
#include "common/math/rotation.hpp"

namespace limbcast::filters {
namespace {

constexpr std::uint32_t kStateVersion = 2;
// The publications use 0.1–1 with the gyros of 2000. Leave-one-out over the twelve public BROAD
// trials picks 0.015–0.03 for a calibrated gyro of today; 0.04 stays on the side of a worse one.
constexpr double kGainWithNull_per_s = 0.04;
constexpr double kGainWithoutNull_per_s = 0.3;
constexpr double kEulerBelow_rad = 0.02;
constexpr double kFullGain_per_s = 1e3;  // more than any rate: one reading is everything
constexpr double kNewtonWithin = 1e-3;
constexpr int kMeasurementOnlySteps = 3;  // suffice from the previous estimate
constexpr double kMagneticUnusedAfter_s = 1.0;

// Densities behind the equivalent covariance: sway of the measured vectors on a moving limb, and
// what the gyro adds. With k = 0.04 they settle at 1.6° per tilt axis and 3° of heading.
constexpr double kTiltNoise_rad2_s = 0.038;
constexpr double kHeadingNoise_rad2_s = 0.137;
constexpr double kGyroNoise_rad2_s = 1e-6;
constexpr double kStartVariance_rad2 = 0.05 * 0.05;
constexpr double kMostVariance_rad2 = 3.3;  // uniform over a turn: π²/3

constexpr std::array<std::string_view, 2> kFormNames = {"reduced", "full"};
constexpr std::array<std::string_view, 3> kIntegrationNames = {"auto", "euler", "exponential"};
constexpr std::array<SettingField<GaussNewtonConfig>, 7> kFields = {
    Choice<&GaussNewtonConfig::form>("form", kFormNames),
    Choice<&GaussNewtonConfig::integration>("integration", kIntegrationNames),
    Number<&GaussNewtonConfig::k_per_s>("k_per_s", 0.0, 100.0),
    Number<&GaussNewtonConfig::rho>("rho", 0.0, 10.0),
    Number<&GaussNewtonConfig::null_time_s>("null_time_s", 0.0, 60.0),
    Whole<&GaussNewtonConfig::iterations>("iterations", 1.0, 20.0),
    Number<&GaussNewtonConfig::init_time_s>("init_time_s", 0.0, 10.0),
};

kernel::Quaternion<double> Plain(const Eigen::Quaterniond& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}
kernel::Vector<double> Plain(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

[[gnu::always_inline]] inline kernel::Quaternion<double> Normalised(
    const kernel::Quaternion<double>& q) {
  const double norm2 = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  if (std::abs(norm2 - 1.0) > kNewtonWithin) {
    const double s = 1.0 / std::sqrt(norm2);
    return {q.w * s, q.x * s, q.y * s, q.z * s};
  }
  return kernel::NormalisedNearOne(q);
}

// The two halves of a sample. Inlined, so that the quaternion stays in registers: through memory,
// numbers stored one by one and loaded in pairs would wait for each other.
[[gnu::always_inline]] inline kernel::Quaternion<double> Integrated(
    const GaussNewtonConfig& config, const kernel::Quaternion<double>& q,
    const Eigen::Vector3d& angle_rad) {
  const bool exponential = config.integration == RateIntegration::kExponential ||
                           (config.integration == RateIntegration::kAuto &&
                            angle_rad.squaredNorm() > kEulerBelow_rad * kEulerBelow_rad);
  if (exponential) {
    return Plain(Eigen::Quaterniond(q.w, q.x, q.y, q.z) * math::ExpSO3(angle_rad));
  }
  return Normalised(
      kernel::TimesOnePlus(q, {0.5 * angle_rad.x(), 0.5 * angle_rad.y(), 0.5 * angle_rad.z()}));
}

[[gnu::always_inline]] inline kernel::Quaternion<double> Corrected(
    const GaussNewtonConfig& config, const Eigen::Vector3d& reference_field,
    kernel::Quaternion<double> q, const GatedSample& sample, bool use_field, double gain,
    int iterations) {
  const double rho = use_field ? config.rho : 0.0;
  const auto h0 = kernel::Scaled(Plain(sample.accel_m_s2), 1.0 / sample.accel_m_s2.norm());
  const auto b0 = use_field ? kernel::Scaled(Plain(sample.mag_tesla), 1.0 / sample.mag_tesla.norm())
                            : kernel::Vector<double>{0.0, 0.0, 0.0};
  const double north = reference_field.y();
  const double up = reference_field.z();
  for (int i = 0; i < iterations; ++i) {
    if (config.form == GaussNewtonForm::kFull4x4) {
      const Eigen::Vector4d dq =
          gain * FullStep(Eigen::Quaterniond(q.w, q.x, q.y, q.z), Eigen::Vector3d::UnitZ(),
                          reference_field, {h0.x, h0.y, h0.z}, {b0.x, b0.y, b0.z}, rho);
      q = Normalised({q.w + dq[0], q.x + dq[1], q.y + dq[2], q.z + dq[3]});
      continue;
    }
    const auto h = kernel::UpInSensor(q);
    const auto n = kernel::NorthInSensor(q);
    const kernel::Vector<double> b{north * n.x + up * h.x, north * n.y + up * h.y,
                                   north * n.z + up * h.z};
    q = Normalised(kernel::TimesOnePlus(
        q, kernel::Scaled(kernel::ReducedStep(h, b, h0, b0, rho * rho), gain)));
  }
  return q;
}

}  // namespace

std::span<const SettingField<GaussNewtonConfig>> GaussNewtonFields() { return kFields; }

Status Validate(const GaussNewtonConfig& config) {
  return ValidateFields<GaussNewtonConfig>("tqt", config, kFields);
}

GaussNewtonOrientation::GaussNewtonOrientation(const GaussNewtonConfig& config) : config_(config) {
  Expects(Validate(config).ok(), "a valid GaussNewtonConfig");
}

void GaussNewtonOrientation::Reset() { state_ = State(); }

std::size_t GaussNewtonOrientation::state_size_bytes() const {
  return SavedStateSize_bytes<State>();
}

void GaussNewtonOrientation::SaveState(std::span<std::byte> out) const {
  WriteState(name(), kStateVersion, state_, out);
}

Status GaussNewtonOrientation::RestoreState(std::span<const std::byte> in) {
  return ReadState(name(), kStateVersion, in, state_);
}

SampleVerdict GaussNewtonOrientation::Update(const sensing::MargSample& sample) {
  const GatedSample gated = state_.gate.Pass(sample);
  if (!gated.usable()) {
    return gated.verdict;
  }
  if (gated.restart) {
    BeginRestart();
  }
  CalibrateNull(gated);
  if (state_.starting) {
    return UpdateStart(gated);
  }

  bool use_field = gated.mag_valid && config_.rho > 0.0;
  if (use_field && !state_.has_field) {
    AdoptField(state_.estimate.q_earth_sensor * gated.mag_tesla);
    use_field = state_.has_field;
  }
  const bool measurement_only = gated.gyro_absent() && !gated.gyro_held;
  auto q = Plain(state_.estimate.q_earth_sensor);
  if (!measurement_only) {
    q = Integrated(config_, q, (gated.gyro_rad_s - state_.estimate.gyro_bias_rad_s) * gated.dt_s);
  }
  const double rate_per_s = measurement_only ? kFullGain_per_s : GainRate_per_s();
  const double gain = measurement_only ? 1.0 : std::min(rate_per_s * gated.dt_s, 1.0);
  if (gated.accel_valid) {
    q = Corrected(config_, state_.reference_field, q, gated, use_field, gain,
                  measurement_only ? std::max(config_.iterations, kMeasurementOnlySteps)
                                   : config_.iterations);
  }
  state_.estimate.q_earth_sensor = Eigen::Quaterniond(q.w, q.x, q.y, q.z);
  SpreadVariance(gated, use_field, gain, rate_per_s);
  Report(gated, use_field);
  CheckAttitude(gated);
  return gated.accel_valid ? SampleVerdict::kFused : SampleVerdict::kPredictedOnly;
}

void GaussNewtonOrientation::BeginRestart() {
  state_.heading_before_rad = math::Heading_rad(state_.estimate.q_earth_sensor);
  state_.starting = true;
  state_.start.Clear();
  state_.rest.Interrupt();
  state_.watchdog.Clear();
}

// With a wrong gyro null the gain that trusts it never finds back: a lost attitude forgets the
// null.
void GaussNewtonOrientation::CheckAttitude(const GatedSample& sample) {
  const Eigen::Vector3d reference_ref = state_.has_field && config_.rho > 0.0
                                            ? state_.reference_field
                                            : Eigen::Vector3d::Zero().eval();
  if (state_.watchdog.Update(sample, state_.estimate.q_earth_sensor,
                             state_.estimate.free_accel_in_earth_m_s2, reference_ref,
                             state_.inverse_field_tesla) == AttitudeLoss::kNone) {
    return;
  }
  BeginRestart();
  state_.estimate.gyro_bias_rad_s.setZero();
  state_.null_known = false;
}

SampleVerdict GaussNewtonOrientation::UpdateStart(const GatedSample& sample) {
  FilterEstimate& estimate = state_.estimate;
  state_.start.Add(sample.gyro_rad_s - estimate.gyro_bias_rad_s, sample.dt_s,
                   sample.accel_valid ? &sample.accel_m_s2 : nullptr,
                   sample.mag_valid ? &sample.mag_tesla : nullptr);
  const auto start = state_.start.Solve();
  // A running start is shown; it counts when its window is full. A restarted filter goes on with
  // it.
  estimate.degraded = estimate.started;
  if (!start) {
    return SampleVerdict::kStarting;
  }
  // Without a field a restarted filter faces the way it did; a new one faces heading 0.
  const double heading_rad =
      start->has_field && config_.rho > 0.0 ? 0.0 : state_.heading_before_rad;
  estimate.q_earth_sensor = math::NearestSign(
      math::ExpSO3({0.0, 0.0, heading_rad}) * start->q_earth_sensor, estimate.q_earth_sensor);
  estimate.w_earth_sensor_in_sensor_rad_s = sample.gyro_rad_s - estimate.gyro_bias_rad_s;
  if (!state_.start.complete(config_.init_time_s)) {
    return SampleVerdict::kStarting;
  }
  if (start->has_field && config_.rho > 0.0 && !state_.has_field) {
    AdoptField(start->mag_in_earth_tesla);  // a restarted filter keeps its reference
  }
  estimate.started = true;
  state_.starting = false;
  state_.var_tilt_rad2 = kStartVariance_rad2;
  state_.var_heading_rad2 = kStartVariance_rad2;
  SpreadVariance(sample, state_.has_field, 0.0, 0.0);
  Report(sample, state_.has_field && sample.mag_valid);
  return SampleVerdict::kFused;
}

// The first field that is seen says where north is: heading moves there at once.
void GaussNewtonOrientation::AdoptField(const Eigen::Vector3d& mag_in_earth_tesla) {
  const double norm = mag_in_earth_tesla.norm();
  const Eigen::Vector3d reference = ReferenceField(mag_in_earth_tesla) / norm;
  if (!(reference.y() > 1e-6)) {
    return;  // vertical: says nothing about heading
  }
  const double north_rad = std::atan2(mag_in_earth_tesla.x(), mag_in_earth_tesla.y());
  state_.estimate.q_earth_sensor =
      math::NearestSign(math::ExpSO3({0.0, 0.0, north_rad}) * state_.estimate.q_earth_sensor,
                        state_.estimate.q_earth_sensor);
  state_.reference_field = reference;
  state_.inverse_field_tesla = 1.0 / norm;
  state_.has_field = true;
  state_.field.Clear();
}

void GaussNewtonOrientation::CalibrateNull(const GatedSample& sample) {
  if (!sample.gyro_measured || !sample.accel_valid) {
    state_.rest.Interrupt();
  } else {
    state_.rest.Update(sample.gyro_rad_s, sample.accel_m_s2, state_.estimate.gyro_bias_rad_s,
                       sample.dt_s);
  }
  state_.estimate.at_rest = state_.rest.at_rest();
  if (state_.null_known || config_.null_time_s == 0.0) {
    return;
  }
  if (state_.rest.still_s() == 0.0) {
    state_.null_sum_rad_s.setZero();
    state_.null_count = 0;
    return;
  }
  state_.null_sum_rad_s += sample.gyro_rad_s;
  ++state_.null_count;
  if (state_.rest.still_s() >= config_.null_time_s) {
    state_.estimate.gyro_bias_rad_s =
        state_.null_sum_rad_s / static_cast<double>(state_.null_count);
    state_.null_known = true;
  }
}

double GaussNewtonOrientation::GainRate_per_s() const {
  if (config_.k_per_s > 0.0) {
    return config_.k_per_s;
  }
  return state_.null_known ? kGainWithNull_per_s : kGainWithoutNull_per_s;
}

// var ← (1 − α)² var + α² r/dt + growth: what the same gain would do to a scalar error.
void GaussNewtonOrientation::SpreadVariance(const GatedSample& sample, bool use_field, double gain,
                                            double rate_per_s) {
  const double dt_s = sample.dt_s;
  double growth = kGyroNoise_rad2_s * dt_s;
  if (sample.gap) {
    growth += kUnseenRate_rad_s * kUnseenRate_rad_s * dt_s * dt_s;
  } else if (sample.gyro_absent() || sample.gyro_saturated) {
    growth += kUnseenRate_rad_s * kUnseenRate_rad_s * dt_s;
  }
  const auto spread = [growth](double var, double kept, double noise_rad2) {
    return std::min(kept * kept * var + noise_rad2 + growth, kMostVariance_rad2);
  };
  // α²/dt = α·k. One reading never counts for worse than the density over a tenth of a second.
  const double weight_per_s = sample.accel_valid ? gain * std::min(rate_per_s, 10.0) : 0.0;
  const double kept = sample.accel_valid ? 1.0 - gain : 1.0;
  state_.var_tilt_rad2 = spread(state_.var_tilt_rad2, kept, weight_per_s * kTiltNoise_rad2_s);
  state_.var_heading_rad2 =
      use_field ? spread(state_.var_heading_rad2, kept, weight_per_s * kHeadingNoise_rad2_s)
                : spread(state_.var_heading_rad2, 1.0, 0.0);
}

void GaussNewtonOrientation::Report(const GatedSample& sample, bool use_field) {
  FilterEstimate& estimate = state_.estimate;
  const auto q = Plain(estimate.q_earth_sensor);
  const auto up_S = kernel::UpInSensor(q);
  if (use_field) {
    const auto mag = Plain(sample.mag_tesla);
    const double scale = state_.inverse_field_tesla;
    state_.field.Update(scale * scale * kernel::Dot(mag, mag), scale * kernel::Dot(up_S, mag),
                        state_.reference_field.z(), sample.dt_s);
  }
  const double mag_absent_s = state_.gate.mag_absent_s();
  const bool field_gone = !state_.has_field || mag_absent_s > kMagneticUnusedAfter_s;
  estimate.magnetic_state = field_gone ? MagneticState::kUnused : state_.field.magnetic_state();
  estimate.heading = state_.has_field && mag_absent_s <= kMagneticMemory_s
                         ? HeadingReference::kMagnetic
                         : HeadingReference::kArbitrary;
  estimate.degraded = sample.gap || sample.gyro_saturated || !sample.accel_valid ||
                      (sample.gyro_absent() && state_.gate.gyro_seen()) ||
                      (state_.has_field && field_gone);
  if (sample.gyro_measured || sample.gyro_held) {
    estimate.w_earth_sensor_in_sensor_rad_s = sample.gyro_rad_s - estimate.gyro_bias_rad_s;
  } else {
    estimate.w_earth_sensor_in_sensor_rad_s.setZero();
  }
  if (sample.accel_valid) {
    const auto accel = Plain(sample.accel_m_s2);
    estimate.free_accel_in_earth_m_s2 = {kernel::Dot(kernel::EastInSensor(q), accel),
                                         kernel::Dot(kernel::NorthInSensor(q), accel),
                                         kernel::Dot(up_S, accel) - kGravity_m_s2};
  } else {
    estimate.free_accel_in_earth_m_s2.setZero();
  }
  estimate.cov_orientation_rad2.diagonal() << state_.var_tilt_rad2, state_.var_tilt_rad2,
      state_.var_heading_rad2;
}

}  // namespace limbcast::filters
