// Notation: E earth (ENU), S sensor; q_ES turns S into E. h and b are up and field in S.
#include "common/filters/gauss_newton_orientation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/filters/filter_constants.hpp"
#include "common/filters/filter_state_codec.hpp"
#include "common/filters/gauss_newton_step.hpp"
#include "common/math/rotation.hpp"

namespace limbcast::filters {
namespace {

constexpr std::uint32_t kStateVersion = 1;
// The publications use 0.1–1 with the gyros of 2000. Leave-one-out over the twelve public BROAD
// trials picks 0.015–0.03 for a calibrated gyro of today; 0.04 stays on the side of a worse one.
constexpr double kGainWithNull_per_s = 0.04;
constexpr double kGainWithoutNull_per_s = 0.3;
constexpr double kEulerBelow_rad = 0.02;
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
    state_.heading_before_rad = math::Heading_rad(state_.estimate.q_earth_sensor);
    state_.starting = true;
    state_.start.Clear();
    state_.rest.Interrupt();
  }
  CalibrateNull(gated);
  if (state_.starting) {
    return UpdateStart(gated);
  }

  const bool measurement_only = gated.gyro_absent() && !gated.gyro_held;
  Integrate((gated.gyro_rad_s - (measurement_only ? Eigen::Vector3d::Zero().eval()
                                                  : state_.estimate.gyro_bias_rad_s)) *
            gated.dt_s);
  bool use_field = gated.mag_valid && config_.rho > 0.0;
  if (use_field && !state_.has_field) {
    AdoptField(state_.estimate.q_earth_sensor * gated.mag_tesla);
    use_field = state_.has_field;
  }
  const double gain = measurement_only ? 1.0 : Gain(gated.dt_s);
  if (gated.accel_valid) {
    Correct(gated, use_field, gain,
            measurement_only ? std::max(config_.iterations, kMeasurementOnlySteps)
                             : config_.iterations);
  }
  SpreadVariance(gated, use_field, gain);
  Report(gated, use_field);
  return gated.accel_valid ? SampleVerdict::kFused : SampleVerdict::kPredictedOnly;
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
  SpreadVariance(sample, state_.has_field, 0.0);
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

double GaussNewtonOrientation::Gain(double dt_s) const {
  const double automatic = state_.null_known ? kGainWithNull_per_s : kGainWithoutNull_per_s;
  return std::min((config_.k_per_s > 0.0 ? config_.k_per_s : automatic) * dt_s, 1.0);
}

void GaussNewtonOrientation::Integrate(const Eigen::Vector3d& angle_rad) {
  Eigen::Quaterniond& q = state_.estimate.q_earth_sensor;
  const bool exponential = config_.integration == RateIntegration::kExponential ||
                           (config_.integration == RateIntegration::kAuto &&
                            angle_rad.squaredNorm() > kEulerBelow_rad * kEulerBelow_rad);
  if (exponential) {
    q = q * math::ExpSO3(angle_rad);
    return;
  }
  const Eigen::Quaterniond step(1.0, 0.5 * angle_rad.x(), 0.5 * angle_rad.y(), 0.5 * angle_rad.z());
  q = (q * step).normalized();
}

void GaussNewtonOrientation::Correct(const GatedSample& sample, bool use_field, double gain,
                                     int iterations) {
  Eigen::Quaterniond& q = state_.estimate.q_earth_sensor;
  const double rho = use_field ? config_.rho : 0.0;
  const Eigen::Vector3d h0_S = sample.accel_m_s2.normalized();
  const Eigen::Vector3d b0_S =
      use_field ? sample.mag_tesla.normalized() : Eigen::Vector3d::Zero().eval();
  for (int i = 0; i < iterations; ++i) {
    if (config_.form == GaussNewtonForm::kFull4x4) {
      const Eigen::Vector4d dq =
          gain * FullStep(q, Eigen::Vector3d::UnitZ(), state_.reference_field, h0_S, b0_S, rho);
      q = Eigen::Quaterniond(q.w() + dq[0], q.x() + dq[1], q.y() + dq[2], q.z() + dq[3])
              .normalized();
      continue;
    }
    const Eigen::Matrix3d R_ES = q.toRotationMatrix();
    const Eigen::Vector3d h_S = R_ES.row(2);
    const Eigen::Vector3d b_S =
        state_.reference_field.y() * R_ES.row(1).transpose() + state_.reference_field.z() * h_S;
    const Eigen::Vector3d dv = gain * ReducedStep(h_S, b_S, h0_S, b0_S, rho);
    q = (q * Eigen::Quaterniond(1.0, dv.x(), dv.y(), dv.z())).normalized();
  }
}

// var ← (1 − α)² var + α² r/dt + growth: what the same gain would do to a scalar error.
void GaussNewtonOrientation::SpreadVariance(const GatedSample& sample, bool use_field,
                                            double gain) {
  const double dt_s = std::max(sample.dt_s, 1e-6);
  double growth = kGyroNoise_rad2_s * dt_s;
  if (sample.gap) {
    growth += kUnseenRate_rad_s * kUnseenRate_rad_s * dt_s * dt_s;
  } else if (sample.gyro_absent() || sample.gyro_saturated) {
    growth += kUnseenRate_rad_s * kUnseenRate_rad_s * dt_s;
  }
  const double gain_tilt = sample.accel_valid ? gain : 0.0;
  const double gain_heading = sample.accel_valid && use_field ? gain : 0.0;
  // Averaging never makes one reading worse than the density over a tenth of a second.
  const double averaging_s = std::max(dt_s, 0.1 * gain);
  const auto spread = [averaging_s, growth](double var, double gain_axis, double noise_rad2_s) {
    const double kept = (1.0 - gain_axis) * (1.0 - gain_axis) * var;
    return std::min(kept + gain_axis * gain_axis * noise_rad2_s / averaging_s + growth,
                    kMostVariance_rad2);
  };
  state_.var_tilt_rad2 = spread(state_.var_tilt_rad2, gain_tilt, kTiltNoise_rad2_s);
  state_.var_heading_rad2 = spread(state_.var_heading_rad2, gain_heading, kHeadingNoise_rad2_s);
}

void GaussNewtonOrientation::Report(const GatedSample& sample, bool use_field) {
  FilterEstimate& estimate = state_.estimate;
  const Eigen::Matrix3d R_ES = estimate.q_earth_sensor.toRotationMatrix();
  if (use_field) {
    const Eigen::Vector3d field_E = R_ES * sample.mag_tesla * state_.inverse_field_tesla;
    state_.field.Update(field_E, state_.reference_field, sample.dt_s);
  }
  const bool field_gone = !state_.has_field || state_.gate.mag_absent_s() > kMagneticUnusedAfter_s;
  estimate.magnetic_state = field_gone ? MagneticState::kUnused : state_.field.magnetic_state();
  estimate.heading = state_.has_field && state_.gate.mag_absent_s() <= kMagneticMemory_s
                         ? HeadingReference::kMagnetic
                         : HeadingReference::kArbitrary;
  estimate.degraded = sample.gap || sample.gyro_saturated || !sample.accel_valid ||
                      (sample.gyro_absent() && state_.gate.gyro_seen()) ||
                      (state_.has_field && field_gone);
  estimate.w_earth_sensor_in_sensor_rad_s =
      sample.gyro_measured || sample.gyro_held
          ? Eigen::Vector3d(sample.gyro_rad_s - estimate.gyro_bias_rad_s)
          : Eigen::Vector3d::Zero();
  if (sample.accel_valid) {
    estimate.free_accel_in_earth_m_s2 =
        R_ES * sample.accel_m_s2 - Eigen::Vector3d(0.0, 0.0, kGravity_m_s2);
  } else {
    estimate.free_accel_in_earth_m_s2.setZero();
  }
  estimate.cov_orientation_rad2.diagonal() << state_.var_tilt_rad2, state_.var_tilt_rad2,
      state_.var_heading_rad2;
}

}  // namespace limbcast::filters
