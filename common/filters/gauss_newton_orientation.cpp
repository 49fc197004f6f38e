// Notation: E earth (ENU), S sensor; q_ES turns S into E.
#include "common/filters/gauss_newton_orientation.hpp"

#include <algorithm>
#include <cmath>

#include "common/filters/batch_kernels.hpp"
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

// Between the core's numbers and everybody else's.
template <typename Scalar>
kernel::Quaternion<Scalar> Plain(const Eigen::Quaterniond& q) {
  const Eigen::Quaternion<Scalar>& c = q.template cast<Scalar>();
  return {c.w(), c.x(), c.y(), c.z()};
}
template <typename Scalar>
kernel::Vector<Scalar> Plain(const Eigen::Vector3d& v) {
  return {static_cast<Scalar>(v.x()), static_cast<Scalar>(v.y()), static_cast<Scalar>(v.z())};
}
template <typename Scalar>
Eigen::Quaterniond Rich(const kernel::Quaternion<Scalar>& q) {
  return {static_cast<double>(q.w), static_cast<double>(q.x), static_cast<double>(q.y),
          static_cast<double>(q.z)};
}
template <typename Scalar>
Eigen::Vector3d Rich(const kernel::Vector<Scalar>& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

template <typename Scalar>
void SetInput(const GatedSample& sample, GaussNewtonInput<Scalar>& input) {
  const double dt_s = sample.dt_s;
  double unseen_rad2 = 0.0;
  if (sample.gap) {
    unseen_rad2 = kUnseenRate_rad_s * kUnseenRate_rad_s * dt_s * dt_s;
  } else if (sample.gyro_absent() || sample.gyro_saturated) {
    unseen_rad2 = kUnseenRate_rad_s * kUnseenRate_rad_s * dt_s;
  }
  const auto flag = [](bool is_set) { return is_set ? Scalar(1) : Scalar(0); };
  input.present = Scalar(1);
  input.dt_s = static_cast<Scalar>(dt_s);
  input.unseen_rad2 = static_cast<Scalar>(unseen_rad2);
  input.gyro_rad_s = Plain<Scalar>(sample.gyro_rad_s);
  input.accel_m_s2 = Plain<Scalar>(sample.accel_m_s2);
  input.mag_tesla = Plain<Scalar>(sample.mag_tesla);
  input.gyro_measured = flag(sample.gyro_measured);
  input.gyro_usable = flag(sample.gyro_measured || sample.gyro_held);
  input.accel_valid = flag(sample.accel_valid);
}

template <typename Scalar>
kernel::Quaternion<Scalar> FullyCorrected(const GaussNewtonState<Scalar>& s,
                                          const kernel::Quaternion<Scalar>& q,
                                          const kernel::Vector<Scalar>& h0,
                                          const kernel::Vector<Scalar>& b0, Scalar rho2,
                                          Scalar gain) {
  const Eigen::Vector3d field_ref = {0.0, static_cast<double>(s.field_north),
                                     static_cast<double>(s.field_up)};
  const Eigen::Matrix<Scalar, 4, 1> dq =
      (static_cast<double>(gain) * FullStep(Rich(q), Eigen::Vector3d::UnitZ(), field_ref, Rich(h0),
                                            Rich(b0), std::sqrt(static_cast<double>(rho2))))
          .template cast<Scalar>();
  return kernel::Normalised<Scalar>({q.w + dq[0], q.x + dq[1], q.y + dq[2], q.z + dq[3]});
}

template <typename Scalar>
inline void StepReduced(const GaussNewtonConfig& config, const GaussNewtonInput<Scalar>& input,
                        GaussNewtonState<Scalar>& core) {
  gauss_newton::Step(config, input, core,
                     [&core](auto&&... step) { return gauss_newton::Corrected(core, step...); });
}

#if defined(__x86_64__)
// The same operations in the same order, so the same bits; AVX has a third operand for each, which
// saves a quarter of the instructions. Everything is inlined here: no function that others may call
// is compiled for AVX.
[[gnu::target("avx2"), gnu::flatten]] void StepReducedAvx2(const GaussNewtonConfig& config,
                                                           const GaussNewtonInput<double>& input,
                                                           GaussNewtonState<double>& core) {
  StepReduced(config, input, core);
}
[[gnu::target("avx2"), gnu::flatten]] void StepReducedAvx2(const GaussNewtonConfig& config,
                                                           const GaussNewtonInput<float>& input,
                                                           GaussNewtonState<float>& core) {
  StepReduced(config, input, core);
}
const bool kHasAvx2 = Avx2Kernels() != nullptr;
#endif

}  // namespace

template <typename Scalar>
GaussNewtonOrientation<Scalar>::GaussNewtonOrientation(const GaussNewtonConfig& config)
    : config_(config) {
  Expects(Validate(config).ok(), "a valid GaussNewtonConfig");
  Reset();
}

template <typename Scalar>
void GaussNewtonOrientation<Scalar>::Reset() {
  state_ = State();
  state_.core.q_ES.w = 1.0;
  state_.core.field_north = 1.0;
}

template <typename Scalar>
std::size_t GaussNewtonOrientation<Scalar>::state_size_bytes() const {
  return SavedStateSize_bytes<State>();
}

template <typename Scalar>
void GaussNewtonOrientation<Scalar>::SaveState(std::span<std::byte> out) const {
  WriteState(name(), kStateVersion, state_, out);
}

template <typename Scalar>
Status GaussNewtonOrientation<Scalar>::RestoreState(std::span<const std::byte> in) {
  return ReadState(name(), kStateVersion, in, state_);
}

template <typename Scalar>
SampleVerdict GaussNewtonOrientation<Scalar>::Update(const sensing::MargSample& sample) {
  return Pass(sample) == SampleStep::kNone ? gated_.verdict : StepAlone();
}

template <typename Scalar>
SampleStep GaussNewtonOrientation<Scalar>::Pass(const sensing::MargSample& sample) {
  state_.gate.Pass(sample, gated_);
  if (!gated_.usable()) {
    return SampleStep::kNone;
  }
  SetInput(gated_, input_);
  const bool has_use = gated_.mag_valid && config_.rho > 0.0;
  input_.use_field = has_use ? state_.core.has_field : Scalar(0);
  const bool adopts = has_use && state_.core.has_field == Scalar(0);
  return gated_.restart || state_.starting || adopts ? SampleStep::kSpecial : SampleStep::kPlain;
}

template <typename Scalar>
SampleVerdict GaussNewtonOrientation<Scalar>::StepAlone() {
  CoreState& core = state_.core;
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
  if (gated_.mag_valid && config_.rho > 0.0 && core.has_field == Scalar(0)) {
    AdoptField(Rich(core.q_ES) * gated_.mag_tesla);
    input_.use_field = core.has_field;
  }
  if (config_.form == GaussNewtonForm::kFull4x4) {
    gauss_newton::Step(config_, input_, core,
                       [&core](auto&&... step) { return FullyCorrected(core, step...); });
#if defined(__x86_64__)
  } else if (kHasAvx2) {
    StepReducedAvx2(config_, input_, core);
#endif
  } else {
    StepReduced(config_, input_, core);
  }
  return Report();
}

template <typename Scalar>
void GaussNewtonOrientation<Scalar>::BeginRestart() {
  state_.heading_before_rad = math::Heading_rad(state_.estimate.q_earth_sensor);
  state_.starting = true;
  state_.start.Clear();
  state_.watchdog.Clear();
}

template <typename Scalar>
void GaussNewtonOrientation<Scalar>::CheckAttitude() {
  if (!state_.watchdog.Add(gated_, state_.estimate.free_accel_in_earth_m_s2)) {
    return;
  }
  const CoreState& core = state_.core;
  const bool has_reference = core.has_field > Scalar(0) && config_.rho > 0.0;
  const Eigen::Vector3d reference_ref =
      has_reference ? Rich(kernel::Vector<Scalar>{Scalar(0), core.field_north, core.field_up})
                    : Eigen::Vector3d::Zero().eval();
  if (state_.watchdog.Look(gated_, state_.estimate.q_earth_sensor, reference_ref,
                           static_cast<double>(core.inverse_field_per_tesla)) ==
      AttitudeLoss::kNone) {
    return;
  }
  BeginRestart();
  state_.lost = true;
}

template <typename Scalar>
SampleVerdict GaussNewtonOrientation<Scalar>::UpdateStart() {
  const GatedSample& sample = gated_;
  FilterEstimate& estimate = state_.estimate;
  CoreState& core = state_.core;
  gauss_newton::CalibrateNull(config_, input_, core);
  estimate.at_rest = static_cast<double>(core.rest.still_s) > kernel::kRestAfter_s;
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
  core.q_ES = Plain<Scalar>(estimate.q_earth_sensor);
  estimate.w_earth_sensor_in_sensor_rad_s = sample.gyro_rad_s - estimate.gyro_bias_rad_s;
  if (!state_.start.complete(config_.init_time_s)) {
    return SampleVerdict::kStarting;
  }
  if (has_use && core.has_field == Scalar(0)) {
    AdoptField(start->mag_in_earth_tesla);  // a restarted filter keeps its reference
  }
  estimate.started = true;
  state_.starting = false;
  core.var_tilt_rad2 = static_cast<Scalar>(kStartVariance_rad2);
  core.var_heading_rad2 = core.var_tilt_rad2;
  CoreInput first = input_;
  first.use_field = core.has_field;
  gauss_newton::SpreadVariance(first, Scalar(0), Scalar(0), core);
  first.use_field = sample.mag_valid ? core.has_field : Scalar(0);
  gauss_newton::Observe(first, core);
  static_cast<void>(Report());
  return SampleVerdict::kFused;
}

// The first field that is seen says where north is: heading moves there at once.
template <typename Scalar>
void GaussNewtonOrientation<Scalar>::AdoptField(const Eigen::Vector3d& mag_in_earth_tesla) {
  CoreState& core = state_.core;
  const double norm = mag_in_earth_tesla.norm();
  const Eigen::Vector3d reference = ReferenceField(mag_in_earth_tesla) / norm;
  if (!(reference.y() > 1e-6)) {
    return;  // vertical: says nothing about heading
  }
  const double north_rad = std::atan2(mag_in_earth_tesla.x(), mag_in_earth_tesla.y());
  const Eigen::Quaterniond before = Rich(core.q_ES);
  core.q_ES =
      Plain<Scalar>(math::NearestSign(math::ExpSO3({0.0, 0.0, north_rad}) * before, before));
  core.field_north = static_cast<Scalar>(reference.y());
  core.field_up = static_cast<Scalar>(reference.z());
  core.inverse_field_per_tesla = static_cast<Scalar>(1.0 / norm);
  core.has_field = Scalar(1);
  core.field_mean_square = Scalar(0);
}

template <typename Scalar>
SampleVerdict GaussNewtonOrientation<Scalar>::Report() {
  const GatedSample& sample = gated_;
  FilterEstimate& estimate = state_.estimate;
  const CoreState& core = state_.core;
  const double mag_absent_s = state_.gate.mag_absent_s();
  const bool has_field = core.has_field > Scalar(0);
  const bool field_gone = !has_field || mag_absent_s > kMagneticUnusedAfter_s;
  estimate.magnetic_state =
      field_gone ? MagneticState::kUnused : FieldState(static_cast<double>(core.field_mean_square));
  estimate.heading = has_field && mag_absent_s <= kMagneticMemory_s ? HeadingReference::kMagnetic
                                                                    : HeadingReference::kArbitrary;
  estimate.degraded = sample.gap || sample.gyro_saturated || !sample.accel_valid ||
                      (sample.gyro_absent() && state_.gate.gyro_seen()) ||
                      (has_field && field_gone);
  estimate.at_rest = static_cast<double>(core.rest.still_s) > kernel::kRestAfter_s;
  estimate.q_earth_sensor = Rich(core.q_ES);
  estimate.gyro_bias_rad_s = Rich(core.null_rad_s);
  estimate.w_earth_sensor_in_sensor_rad_s = Rich(core.w_ES_S_rad_s);
  estimate.free_accel_in_earth_m_s2 = Rich(core.free_accel_E_m_s2);
  const auto var_tilt_rad2 = static_cast<double>(core.var_tilt_rad2);
  estimate.cov_orientation_rad2.diagonal() << var_tilt_rad2, var_tilt_rad2,
      static_cast<double>(core.var_heading_rad2);
  CheckAttitude();
  return sample.accel_valid ? SampleVerdict::kFused : SampleVerdict::kPredictedOnly;
}

template class GaussNewtonOrientation<double>;
template class GaussNewtonOrientation<float>;

std::unique_ptr<OrientationFilter> MakeGaussNewtonOrientation(const GaussNewtonConfig& config) {
  if (config.precision == Precision::kFloat) {
    return std::make_unique<GaussNewtonOrientation<float>>(config);
  }
  return std::make_unique<GaussNewtonOrientation<double>>(config);
}

}  // namespace limbcast::filters
