// Notation: E earth (ENU), S sensor; q_ES turns S into E.
#include "common/filters/gauss_newton_orientation.hpp"

#include <algorithm>
#include <cmath>

#include "common/filters/field_monitor.hpp"
#include "common/filters/filter_constants.hpp"
#include "common/filters/filter_state_codec.hpp"
#include "common/filters/gauss_newton_step.hpp"
#include "common/math/rotation.hpp"

namespace limbcast::filters {
namespace {

constexpr std::uint32_t kStateVersion = 2;
constexpr double kMagneticUnusedAfter_s = 1.0;
constexpr double kStartVariance_rad2 = 0.05 * 0.05;

using PlainQuaternion = kernel::Quaternion<double>;
using PlainVector = kernel::Vector<double>;

PlainQuaternion Plain(const Eigen::Quaterniond& q) { return {q.w(), q.x(), q.y(), q.z()}; }
PlainVector Plain(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
Eigen::Quaterniond Rich(const PlainQuaternion& q) { return {q.w, q.x, q.y, q.z}; }
Eigen::Vector3d Rich(const PlainVector& v) { return {v.x, v.y, v.z}; }

void SetInput(const GatedSample& sample, GaussNewtonInput<double>& input) {
  const double dt_s = sample.dt_s;
  input.present = 1.0;
  input.dt_s = dt_s;
  input.unseen_rad2 = 0.0;
  if (sample.gap) {
    input.unseen_rad2 = kUnseenRate_rad_s * kUnseenRate_rad_s * dt_s * dt_s;
  } else if (sample.gyro_absent() || sample.gyro_saturated) {
    input.unseen_rad2 = kUnseenRate_rad_s * kUnseenRate_rad_s * dt_s;
  }
  input.gyro_rad_s = Plain(sample.gyro_rad_s);
  input.accel_m_s2 = Plain(sample.accel_m_s2);
  input.mag_tesla = Plain(sample.mag_tesla);
  input.gyro_measured = sample.gyro_measured ? 1.0 : 0.0;
  input.gyro_usable = sample.gyro_measured || sample.gyro_held ? 1.0 : 0.0;
  input.accel_valid = sample.accel_valid ? 1.0 : 0.0;
}

PlainQuaternion FullyCorrected(const GaussNewtonState<double>& s, const PlainQuaternion& q,
                               const PlainVector& h0, const PlainVector& b0, double rho2,
                               double gain) {
  const Eigen::Vector4d dq =
      gain * FullStep(Rich(q), Eigen::Vector3d::UnitZ(), {0.0, s.field_north, s.field_up}, Rich(h0),
                      Rich(b0), std::sqrt(rho2));
  return kernel::Normalised<double>({q.w + dq[0], q.x + dq[1], q.y + dq[2], q.z + dq[3]});
}

}  // namespace

GaussNewtonOrientation::GaussNewtonOrientation(const GaussNewtonConfig& config) : config_(config) {
  Expects(Validate(config).ok(), "a valid GaussNewtonConfig");
  Reset();
}

void GaussNewtonOrientation::Reset() {
  state_ = State();
  state_.core.q_ES.w = 1.0;
  state_.core.field_north = 1.0;
}

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
  return Pass(sample) == SampleStep::kNone ? gated_.verdict : StepAlone();
}

SampleStep GaussNewtonOrientation::Pass(const sensing::MargSample& sample) {
  state_.gate.Pass(sample, gated_);
  if (!gated_.usable()) {
    return SampleStep::kNone;
  }
  SetInput(gated_, input_);
  const bool has_use = gated_.mag_valid && config_.rho > 0.0;
  input_.use_field = has_use ? state_.core.has_field : 0.0;
  const bool adopts = has_use && state_.core.has_field == 0.0;
  return gated_.restart || state_.starting || adopts ? SampleStep::kSpecial : SampleStep::kPlain;
}

SampleVerdict GaussNewtonOrientation::StepAlone() {
  GaussNewtonState<double>& core = state_.core;
  if (gated_.restart) {
    BeginRestart();
    core.rest.still_s = 0.0;
  }
  if (state_.lost) {
    // With a wrong null the gain that trusts it never finds back.
    core.rest.still_s = 0.0;
    core.null_rad_s = {};
    core.null_known = 0.0;
    state_.lost = false;
  }
  if (state_.starting) {
    return UpdateStart();
  }
  if (gated_.mag_valid && config_.rho > 0.0 && core.has_field == 0.0) {
    AdoptField(Rich(core.q_ES) * gated_.mag_tesla);
    input_.use_field = core.has_field;
  }
  if (config_.form == GaussNewtonForm::kFull4x4) {
    gauss_newton::Step(config_, input_, core,
                       [&core](auto&&... step) { return FullyCorrected(core, step...); });
  } else {
    gauss_newton::Step(config_, input_, core,
                       [&core](auto&&... step) { return gauss_newton::Corrected(core, step...); });
  }
  return Report();
}

void GaussNewtonOrientation::BeginRestart() {
  state_.heading_before_rad = math::Heading_rad(state_.estimate.q_earth_sensor);
  state_.starting = true;
  state_.start.Clear();
  state_.watchdog.Clear();
}

void GaussNewtonOrientation::CheckAttitude() {
  if (!state_.watchdog.Add(gated_, state_.estimate.free_accel_in_earth_m_s2)) {
    return;
  }
  const GaussNewtonState<double>& core = state_.core;
  const Eigen::Vector3d reference_ref = core.has_field > 0.0 && config_.rho > 0.0
                                            ? Eigen::Vector3d(0.0, core.field_north, core.field_up)
                                            : Eigen::Vector3d::Zero().eval();
  if (state_.watchdog.Look(gated_, state_.estimate.q_earth_sensor, reference_ref,
                           core.inverse_field_per_tesla) == AttitudeLoss::kNone) {
    return;
  }
  BeginRestart();
  state_.lost = true;
}

SampleVerdict GaussNewtonOrientation::UpdateStart() {
  const GatedSample& sample = gated_;
  FilterEstimate& estimate = state_.estimate;
  GaussNewtonState<double>& core = state_.core;
  gauss_newton::CalibrateNull(config_, input_, core);
  estimate.at_rest = core.rest.still_s > kernel::kRestAfter_s;
  estimate.gyro_bias_rad_s = Rich(core.null_rad_s);
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
  const bool has_use = start->has_field && config_.rho > 0.0;
  const double heading_rad = has_use ? 0.0 : state_.heading_before_rad;
  estimate.q_earth_sensor = math::NearestSign(
      math::ExpSO3({0.0, 0.0, heading_rad}) * start->q_earth_sensor, estimate.q_earth_sensor);
  core.q_ES = Plain(estimate.q_earth_sensor);
  estimate.w_earth_sensor_in_sensor_rad_s = sample.gyro_rad_s - estimate.gyro_bias_rad_s;
  if (!state_.start.complete(config_.init_time_s)) {
    return SampleVerdict::kStarting;
  }
  if (has_use && core.has_field == 0.0) {
    AdoptField(start->mag_in_earth_tesla);  // a restarted filter keeps its reference
  }
  estimate.started = true;
  state_.starting = false;
  core.var_tilt_rad2 = kStartVariance_rad2;
  core.var_heading_rad2 = kStartVariance_rad2;
  GaussNewtonInput<double> first = input_;
  first.use_field = core.has_field;
  gauss_newton::SpreadVariance(first, 0.0, 0.0, core);
  first.use_field = sample.mag_valid ? core.has_field : 0.0;
  gauss_newton::Observe(first, core);
  static_cast<void>(Report());
  return SampleVerdict::kFused;
}

// The first field that is seen says where north is: heading moves there at once.
void GaussNewtonOrientation::AdoptField(const Eigen::Vector3d& mag_in_earth_tesla) {
  GaussNewtonState<double>& core = state_.core;
  const double norm = mag_in_earth_tesla.norm();
  const Eigen::Vector3d reference = ReferenceField(mag_in_earth_tesla) / norm;
  if (!(reference.y() > 1e-6)) {
    return;  // vertical: says nothing about heading
  }
  const double north_rad = std::atan2(mag_in_earth_tesla.x(), mag_in_earth_tesla.y());
  const Eigen::Quaterniond before = Rich(core.q_ES);
  core.q_ES = Plain(math::NearestSign(math::ExpSO3({0.0, 0.0, north_rad}) * before, before));
  core.field_north = reference.y();
  core.field_up = reference.z();
  core.inverse_field_per_tesla = 1.0 / norm;
  core.has_field = 1.0;
  core.field_mean_square = 0.0;
}

SampleVerdict GaussNewtonOrientation::Report() {
  const GatedSample& sample = gated_;
  FilterEstimate& estimate = state_.estimate;
  const GaussNewtonState<double>& core = state_.core;
  const double mag_absent_s = state_.gate.mag_absent_s();
  const bool has_field = core.has_field > 0.0;
  const bool field_gone = !has_field || mag_absent_s > kMagneticUnusedAfter_s;
  estimate.magnetic_state =
      field_gone ? MagneticState::kUnused : FieldState(core.field_mean_square);
  estimate.heading = has_field && mag_absent_s <= kMagneticMemory_s ? HeadingReference::kMagnetic
                                                                    : HeadingReference::kArbitrary;
  estimate.degraded = sample.gap || sample.gyro_saturated || !sample.accel_valid ||
                      (sample.gyro_absent() && state_.gate.gyro_seen()) ||
                      (has_field && field_gone);
  estimate.at_rest = core.rest.still_s > kernel::kRestAfter_s;
  estimate.q_earth_sensor = Rich(core.q_ES);
  estimate.gyro_bias_rad_s = Rich(core.null_rad_s);
  estimate.w_earth_sensor_in_sensor_rad_s = Rich(core.w_ES_S_rad_s);
  estimate.free_accel_in_earth_m_s2 = Rich(core.free_accel_E_m_s2);
  estimate.cov_orientation_rad2.diagonal() << core.var_tilt_rad2, core.var_tilt_rad2,
      core.var_heading_rad2;
  CheckAttitude();
  return sample.accel_valid ? SampleVerdict::kFused : SampleVerdict::kPredictedOnly;
}

}  // namespace limbcast::filters
