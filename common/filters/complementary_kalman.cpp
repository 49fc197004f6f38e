// Notation: E earth (ENU), S sensor; q_ES and R turn S into E. Symbols of the thesis: Z and H are
// up and field in S, a the acceleration, d the disturbance, C the measurement matrix.
#include "common/filters/complementary_kalman.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "common/filters/filter_constants.hpp"
#include "common/filters/filter_state_codec.hpp"
#include "common/math/rotation.hpp"

namespace limbcast::filters {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using C = ComplementaryKalmanConfig;

constexpr std::uint32_t kStateVersion = 2;
constexpr double kPublishedStep_s = 0.01;
constexpr double kFieldLowPass_hz = 10.0;
constexpr double kMagneticUnusedAfter_s = 1.0;
constexpr double kSaturatedRateShare = 0.2;
constexpr double kMostField_ref = 20.0;       // a stronger one says nothing about north
constexpr double kMinInnovationForce = 0.05;  // share of g

constexpr std::array<std::string_view, 2> kStructureNames = {"full", "thesis"};
constexpr std::array<std::string_view, 2> kMeasureNames = {"deviation", "change"};
constexpr std::array kFields = {
    Choice<&C::structure>("structure", kStructureNames),
    Choice<&C::disturbance_measure>("disturbance_measure", kMeasureNames),
    Flag<&C::use_disturbance>("use_disturbance"),
    Number<&C::init_time_s>("init_time_s", 0.0, 10.0),
    Number<&C::sigma_gyro_rad_s>("sigma_gyro_rad_s", 0.0, 10.0, true),
    Number<&C::walk_gyro_bias_rad_s>("walk_gyro_bias_rad_s", 0.0, 1.0),
    Number<&C::sigma_gyro_bias_start_rad_s>("sigma_gyro_bias_start_rad_s", 0.0, 1.0),
    Number<&C::pole_accel>("pole_accel", 0.0, 1.0),
    Number<&C::drive_accel_m_s2>("drive_accel_m_s2", 0.0, 100.0, true),
    Number<&C::sigma_accel_m_s2>("sigma_accel_m_s2", 0.0, 10.0, true),
    Number<&C::sigma_mag_ref>("sigma_mag_ref", 0.0, 10.0, true),
    Number<&C::pole_disturbance>("pole_disturbance", 0.0, 1.0),
    Number<&C::drive_norm>("drive_norm", 0.0, 10.0),
    Number<&C::drive_dip_per_rad>("drive_dip_per_rad", 0.0, 10.0),
    Number<&C::drive_floor_ref>("drive_floor_ref", 0.0, 10.0),
    Number<&C::sigma_orientation_start_rad>("sigma_orientation_start_rad", 0.0, 3.0, true),
};

// Angle of the field below the horizon; up is z [R·2.10 corrected].
double Dip_rad(const Vector3d& field_E) {
  return std::atan2(-field_E.z(), std::hypot(field_E.x(), field_E.y()));
}

}  // namespace

std::span<const SettingField<ComplementaryKalmanConfig>> ComplementaryKalmanFields() {
  return kFields;
}

Status Validate(const ComplementaryKalmanConfig& config) {
  return ValidateFields<ComplementaryKalmanConfig>("ckf", config, kFields);
}

ComplementaryKalman::ComplementaryKalman(const ComplementaryKalmanConfig& config)
    : config_(config) {
  Expects(Validate(config).ok(), "a valid ComplementaryKalmanConfig");
}

void ComplementaryKalman::Reset() { state_ = State(); }

std::size_t ComplementaryKalman::state_size_bytes() const { return SavedStateSize_bytes<State>(); }

void ComplementaryKalman::SaveState(std::span<std::byte> out) const {
  WriteState(name(), kStateVersion, state_, out);
}

Status ComplementaryKalman::RestoreState(std::span<const std::byte> in) {
  return ReadState(name(), kStateVersion, in, state_);
}

SampleVerdict ComplementaryKalman::Update(const sensing::MargSample& sample) {
  const GatedSample gated = state_.gate.Pass(sample);
  if (!gated.usable()) {
    return gated.verdict;
  }
  if (gated.restart) {
    BeginRestart();
  }
  DetectRest(gated);
  if (state_.starting) {
    return UpdateStart(gated);
  }
  if (gated.mag_valid && !state_.has_field) {
    AdoptField(state_.estimate.q_earth_sensor * gated.mag_tesla);
  }
  const bool use_field = gated.mag_valid && state_.has_field &&
                         gated.mag_tesla.norm() * state_.inverse_field_tesla < kMostField_ref;
  SetStep(gated.dt_s);
  Predict(gated);
  if (config_.use_disturbance) {
    const double drive = DisturbanceDrive(gated, use_field);
    state_.P.diagonal().tail<3>().array() += drive * drive * step_.ratio;
  }
  if (gated.accel_valid) {
    Correct(gated, use_field);
  }
  GuardCovariance();
  Report(gated, use_field);
  CheckAttitude(gated);
  return gated.accel_valid ? SampleVerdict::kFused : SampleVerdict::kPredictedOnly;
}

void ComplementaryKalman::BeginRestart() {
  state_.heading_before_rad = math::Heading_rad(state_.estimate.q_earth_sensor);
  state_.starting = true;
  state_.start.Clear();
  state_.rest.Interrupt();
  state_.watchdog.Clear();
}

// A lost attitude takes with it what was learned while it was lost.
void ComplementaryKalman::CheckAttitude(const GatedSample& sample) {
  if (!state_.watchdog.Add(sample, state_.estimate.free_accel_in_earth_m_s2)) {
    return;
  }
  const Vector3d reference_ref = state_.has_field ? state_.m0_E : Vector3d::Zero().eval();
  if (state_.watchdog.Look(sample, state_.estimate.q_earth_sensor, reference_ref,
                           state_.inverse_field_tesla) == AttitudeLoss::kNone) {
    return;
  }
  BeginRestart();
  state_.estimate.gyro_bias_rad_s.setZero();
  ResetCovariance();
}

SampleVerdict ComplementaryKalman::UpdateStart(const GatedSample& sample) {
  FilterEstimate& estimate = state_.estimate;
  state_.start.Add(sample.gyro_rad_s - estimate.gyro_bias_rad_s, sample.dt_s,
                   sample.accel_valid ? &sample.accel_m_s2 : nullptr,
                   sample.mag_valid ? &sample.mag_tesla : nullptr);
  const auto start = state_.start.Solve();
  estimate.degraded = estimate.started;
  if (!start) {
    return SampleVerdict::kStarting;
  }
  // Without a field a restarted filter faces the way it did; a new one faces heading 0.
  const double heading_rad = start->has_field ? 0.0 : state_.heading_before_rad;
  estimate.q_earth_sensor = math::NearestSign(
      math::ExpSO3({0.0, 0.0, heading_rad}) * start->q_earth_sensor, estimate.q_earth_sensor);
  if (!state_.start.complete(config_.init_time_s)) {
    return SampleVerdict::kStarting;
  }
  if (start->has_field && !state_.has_field) {
    AdoptField(start->mag_in_earth_tesla);  // a restarted filter keeps its reference
  }
  const Matrix3d P_bb = state_.P.block<3, 3>(3, 3);
  ResetCovariance();
  if (estimate.started) {
    state_.P.block<3, 3>(3, 3) = P_bb;  // and what it learned of the gyro
  }
  estimate.started = true;
  state_.starting = false;
  state_.a_E.setZero();
  state_.d_E.setZero();
  Report(sample, false);
  return SampleVerdict::kFused;
}

// The first field that is seen says where north is: heading moves there at once.
void ComplementaryKalman::AdoptField(const Vector3d& mag_in_earth_tesla) {
  const double norm = mag_in_earth_tesla.norm();
  const Vector3d reference = ReferenceField(mag_in_earth_tesla) / norm;
  if (!(reference.y() > 1e-6)) {
    return;  // vertical: says nothing about heading
  }
  const double north_rad = std::atan2(mag_in_earth_tesla.x(), mag_in_earth_tesla.y());
  state_.estimate.q_earth_sensor =
      math::NearestSign(math::ExpSO3({0.0, 0.0, north_rad}) * state_.estimate.q_earth_sensor,
                        state_.estimate.q_earth_sensor);
  state_.m0_E = reference;
  state_.inverse_field_tesla = 1.0 / norm;
  state_.norm_low = 1.0;
  state_.dip_low_rad = Dip_rad(reference);
  state_.has_field = true;
  state_.field.Clear();
}

void ComplementaryKalman::ResetCovariance() {
  const double theta = config_.sigma_orientation_start_rad;
  const double bias = config_.sigma_gyro_bias_start_rad_s;
  state_.P.setZero();
  state_.P.diagonal() << Vector3d::Constant(theta * theta), Vector3d::Constant(bias * bias),
      Vector3d::Zero();
  state_.cov_accel = config_.sigma_accel_m_s2 * config_.sigma_accel_m_s2 * Matrix3d::Identity();
}

void ComplementaryKalman::GuardCovariance() {
  if (state_.P.allFinite() && state_.P.diagonal().minCoeff() >= 0.0 &&
      state_.cov_accel.allFinite()) {
    return;
  }
  ResetCovariance();
  ++state_.covariance_resets;
}

void ComplementaryKalman::SetStep(double dt_s) {
  if (dt_s == step_.dt_s) {
    return;
  }
  step_.dt_s = dt_s;
  step_.ratio = dt_s / kPublishedStep_s;
  step_.c_a = std::pow(config_.pole_accel, step_.ratio);
  step_.c_d = std::pow(config_.pole_disturbance, step_.ratio);
}

void ComplementaryKalman::Predict(const GatedSample& sample) {
  FilterEstimate& estimate = state_.estimate;
  const double T = step_.dt_s;
  const bool blind = sample.gyro_absent() && !sample.gyro_held;
  const Vector3d w_S =
      blind ? Vector3d::Zero().eval() : Vector3d(sample.gyro_rad_s - estimate.gyro_bias_rad_s);
  estimate.w_earth_sensor_in_sensor_rad_s = w_S;
  estimate.q_earth_sensor = (estimate.q_earth_sensor * math::ExpSO3(w_S * T)).normalized();
  state_.a_E *= step_.c_a;
  state_.d_E *= step_.c_d;

  state_.P = config_.structure == KalmanStructure::kFull
                 ? PropagateFull(state_.P, w_S, T, step_.c_d)
                 : PropagateBlocks(state_.P, T, step_.c_d);
  // T²σ_G² with the variance of one sample scaled by 10 ms / T.
  double var_theta_rad2 =
      config_.sigma_gyro_rad_s * config_.sigma_gyro_rad_s * T * kPublishedStep_s;
  if (sample.gap) {
    var_theta_rad2 += kUnseenRate_rad_s * kUnseenRate_rad_s * T * T;
  } else if (blind) {
    var_theta_rad2 += kUnseenRate_rad_s * kUnseenRate_rad_s * T;
  } else if (sample.gyro_saturated) {
    var_theta_rad2 += kSaturatedRateShare * kSaturatedRateShare * w_S.squaredNorm() * T;
  }
  const double walk = config_.walk_gyro_bias_rad_s;
  state_.P.diagonal().head<3>().array() += var_theta_rad2;
  state_.P.diagonal().segment<3>(3).array() += walk * walk * step_.ratio;
}

// σ_d [R·2.12 corrected]: norm and dip are low-passed, so that noise of the sensor is none of the
// field.
double ComplementaryKalman::DisturbanceDrive(const GatedSample& sample, bool use_field) {
  if (!use_field) {
    return config_.drive_floor_ref;
  }
  const Vector3d field_E =
      state_.estimate.q_earth_sensor * sample.mag_tesla * state_.inverse_field_tesla;
  const double norm_before = state_.norm_low;
  const double dip_before_rad = state_.dip_low_rad;
  const double time_constant_s = 1.0 / (2.0 * std::numbers::pi * kFieldLowPass_hz);
  const double gain = step_.dt_s / (time_constant_s + step_.dt_s);
  state_.norm_low += gain * (field_E.norm() - state_.norm_low);
  state_.dip_low_rad += gain * (Dip_rad(field_E) - state_.dip_low_rad);
  const bool change = config_.disturbance_measure == DisturbanceMeasure::kChange;
  const double norm_error = state_.norm_low - (change ? norm_before : 1.0);
  const double dip_error_rad =
      state_.dip_low_rad - (change ? dip_before_rad : Dip_rad(state_.m0_E));
  return config_.drive_norm * std::abs(norm_error) +
         config_.drive_dip_per_rad * std::abs(dip_error_rad) + config_.drive_floor_ref;
}

void ComplementaryKalman::Correct(const GatedSample& sample, bool use_field) {
  const Matrix3d R_SE = state_.estimate.q_earth_sensor.toRotationMatrix().transpose();
  const Vector3d Z = R_SE.col(2);
  const Vector3d H = R_SE * state_.m0_E;
  const Vector3d d = R_SE * state_.d_E;
  const Vector3d gravity_measured = sample.accel_m_s2 - R_SE * state_.a_E;
  const double gravity_norm = gravity_measured.norm();
  if (gravity_norm < kMinInnovationForce * kGravity_m_s2) {
    return;
  }
  Matrix69 C_x = ComplementaryMeasurementMatrix(Z, H, d);
  Eigen::Matrix<double, 6, 1> z;
  z << gravity_measured / gravity_norm - Z, sample.mag_tesla * state_.inverse_field_tesla - d - H;
  const double var_accel = config_.sigma_accel_m_s2 * config_.sigma_accel_m_s2;
  const double var_drive = config_.drive_accel_m_s2 * config_.drive_accel_m_s2 * step_.ratio;
  const double per_g2 = 1.0 / (kGravity_m_s2 * kGravity_m_s2);
  Eigen::Matrix<double, 6, 6> V = Eigen::Matrix<double, 6, 6>::Zero();
  V.topLeftCorner<3, 3>() = per_g2 * step_.c_a * step_.c_a * state_.cov_accel;
  V.diagonal().head<3>().array() += per_g2 * (var_drive + var_accel);
  V.diagonal().tail<3>().array() += config_.sigma_mag_ref * config_.sigma_mag_ref;
  if (!use_field) {
    C_x.bottomRows<3>().setZero();
    z.tail<3>().setZero();
  }
  const Eigen::Matrix<double, 9, 6> PCt = state_.P * C_x.transpose();
  const Eigen::Matrix<double, 6, 6> innovation = C_x * PCt + V;
  const Eigen::LLT<Eigen::Matrix<double, 6, 6>> factor(innovation);
  const Eigen::Matrix<double, 9, 6> K = factor.solve(PCt.transpose()).transpose();
  state_.P -= K * PCt.transpose();
  state_.P = (0.5 * (state_.P + state_.P.transpose())).eval();
  const Vector9 x = K * z;
  if (!x.allFinite()) {
    state_.P.setConstant(NAN);  // a reset is due
    return;
  }
  Inject(x);

  // The acceleration that the corrected attitude leaves, and how well it is known [R·2.17].
  const Matrix3d R_ES = state_.estimate.q_earth_sensor.toRotationMatrix();
  const Vector3d Z_after = R_ES.row(2);
  state_.a_E = R_ES * (sample.accel_m_s2 - kGravity_m_s2 * Z_after);
  const Matrix3d Z_x = math::Skew(Z_after);
  state_.cov_accel =
      kGravity_m_s2 * kGravity_m_s2 * Z_x * state_.P.topLeftCorner<3, 3>() * Z_x.transpose();
  state_.cov_accel.diagonal().array() += var_accel;
}

void ComplementaryKalman::Inject(const Vector9& x) {
  FilterEstimate& estimate = state_.estimate;
  const Quaterniond before = estimate.q_earth_sensor;
  state_.d_E -= before * x.tail<3>();
  estimate.q_earth_sensor = (before * math::ExpSO3(-x.head<3>())).normalized();
  estimate.gyro_bias_rad_s -= x.segment<3>(3);
}

void ComplementaryKalman::DetectRest(const GatedSample& sample) {
  if (sample.gyro_measured && sample.accel_valid) {
    state_.rest.Update(sample.gyro_rad_s, sample.accel_m_s2, state_.estimate.gyro_bias_rad_s,
                       sample.dt_s);
  } else {
    state_.rest.Interrupt();
  }
  state_.estimate.at_rest = state_.rest.at_rest();
}

void ComplementaryKalman::Report(const GatedSample& sample, bool use_field) {
  FilterEstimate& estimate = state_.estimate;
  const Matrix3d R_ES = estimate.q_earth_sensor.toRotationMatrix();
  if (use_field) {
    const Vector3d field_ref = sample.mag_tesla * state_.inverse_field_tesla;
    state_.field.Update(field_ref.squaredNorm(), R_ES.row(2).dot(field_ref), state_.m0_E.z(),
                        sample.dt_s);
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
  if (sample.accel_valid) {
    estimate.free_accel_in_earth_m_s2 =
        R_ES * sample.accel_m_s2 - Vector3d(0.0, 0.0, kGravity_m_s2);
  } else {
    estimate.free_accel_in_earth_m_s2.setZero();
  }
  estimate.cov_orientation_rad2 = R_ES * state_.P.topLeftCorner<3, 3>() * R_ES.transpose();
}

}  // namespace limbcast::filters
