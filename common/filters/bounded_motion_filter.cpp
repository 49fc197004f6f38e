// Notation: E earth (ENU), S sensor; q_ES turns S into E.
#include "common/filters/bounded_motion_filter.hpp"

#include <algorithm>
#include <cmath>

#include "common/filters/filter_constants.hpp"
#include "common/filters/filter_state_codec.hpp"
#include "common/math/rotation.hpp"

namespace limbcast::filters {
namespace {

constexpr std::uint32_t kStateVersion = 3;
constexpr double kMagneticUnusedAfter_s = 1.0;
constexpr double kDisturbedAbove_ref = 0.15;
constexpr double kSaturatedRateShare = 0.2;
constexpr int kMostSubSteps = 500;
constexpr double kAnyHeading_rad2 =
    3.3;                              // π²/3: the variance of a heading that nothing is known of
constexpr double kLostStart_s = 2.0;  // nobody waits for rest: the mean over motion needs longer

template <typename Scalar>
Eigen::Matrix3d AttitudeCovariance(const BoundedMotionState<Scalar>& s) {
  Eigen::Matrix3d P_rad2;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      P_rad2(row, column) = static_cast<double>(s.P(row, column));
    }
  }
  return P_rad2;
}

}  // namespace

template <typename Scalar>
BoundedMotionFilter<Scalar>::BoundedMotionFilter(const BoundedMotionConfig& config,
                                                 std::string_view name)
    : core_(config), name_(name) {
  Expects(Validate(config).ok(), "a valid BoundedMotionConfig");
}

template <typename Scalar>
void BoundedMotionFilter<Scalar>::Reset() {
  core_ = BoundedMotionCore<Scalar>(core_.config());
  state_ = State();
}

template <typename Scalar>
std::size_t BoundedMotionFilter<Scalar>::state_size_bytes() const {
  return SavedStateSize_bytes<Saved>();
}

template <typename Scalar>
void BoundedMotionFilter<Scalar>::SaveState(std::span<std::byte> out) const {
  WriteState(name_, kStateVersion, Saved{state_, core_.state()}, out);
}

template <typename Scalar>
Status BoundedMotionFilter<Scalar>::RestoreState(std::span<const std::byte> in) {
  Saved saved{state_, core_.state()};
  if (Status read = ReadState(name_, kStateVersion, in, saved); !read) {
    return read;
  }
  state_ = saved.state;
  core_.mutable_state() = saved.core;
  return Ok();
}

template <typename Scalar>
SampleVerdict BoundedMotionFilter<Scalar>::Update(const sensing::MargSample& sample) {
  return Pass(sample) == SampleStep::kNone ? gated_.verdict : StepAlone();
}

template <typename Scalar>
SampleStep BoundedMotionFilter<Scalar>::Pass(const sensing::MargSample& sample) {
  state_.gate.Pass(sample, gated_);
  if (!gated_.usable()) {
    return SampleStep::kNone;
  }
  const Scalar has_field = core_.state().has_field;
  input_.dt_s = static_cast<Scalar>(gated_.dt_s);
  input_.gyro_rad_s = gated_.gyro_rad_s.template cast<Scalar>();
  input_.accel_m_s2 = gated_.accel_m_s2.template cast<Scalar>();
  input_.mag = gated_.mag_tesla.template cast<Scalar>();
  input_.rest_allowed = gated_.gyro_measured && !gated_.gap ? Scalar(1) : Scalar(0);
  input_.accel_valid = gated_.accel_valid ? Scalar(1) : Scalar(0);
  input_.mag_valid = gated_.mag_valid ? has_field : Scalar(0);
  const bool adopts = gated_.mag_valid && has_field == Scalar(0);
  const bool plain = !gated_.restart && !state_.starting && !adopts && !gated_.gap &&
                     !gated_.gyro_saturated && (gated_.gyro_measured || gated_.gyro_held);
  return plain ? SampleStep::kPlain : SampleStep::kSpecial;
}

template <typename Scalar>
SampleVerdict BoundedMotionFilter<Scalar>::StepAlone() {
  if (gated_.restart) {
    BeginRestart();
  }
  if (state_.starting) {
    return UpdateStart();
  }
  if (gated_.mag_valid && core_.state().has_field == Scalar(0)) {
    AdoptField(core_.state().q_ES.template cast<double>() * gated_.mag_tesla);
    input_.mag_valid = core_.state().has_field;
  }
  Feed();
  return Report();
}

template <typename Scalar>
void BoundedMotionFilter<Scalar>::BeginRestart() {
  state_.heading_before_rad = math::Heading_rad(state_.estimate.q_earth_sensor);
  state_.starting = true;
  state_.start.Clear();
  state_.watchdog.Clear();
}

// A lost attitude takes with it what was learned while it was lost.
template <typename Scalar>
void BoundedMotionFilter<Scalar>::CheckAttitude() {
  if (!state_.watchdog.Add(gated_, state_.estimate.free_accel_in_earth_m_s2)) {
    return;
  }
  const double norm_tesla = state_.reference_tesla.norm();
  const double per_tesla = norm_tesla > 0.0 ? 1.0 / norm_tesla : 0.0;
  if (state_.watchdog.Look(gated_, state_.estimate.q_earth_sensor,
                           per_tesla * state_.reference_tesla, per_tesla) != AttitudeLoss::kNone) {
    BeginRestart();
    state_.lost = true;
  }
}

template <typename Scalar>
SampleVerdict BoundedMotionFilter<Scalar>::UpdateStart() {
  const GatedSample& sample = gated_;
  FilterEstimate& estimate = state_.estimate;
  const Eigen::Vector3d bias_rad_s =
      state_.lost ? Eigen::Vector3d::Zero() : core_.state().b_g.template cast<double>().eval();
  state_.start.Add(sample.gyro_rad_s - bias_rad_s, sample.dt_s,
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
  if (!state_.start.complete(
          std::max(core_.config().init_time_s, state_.lost ? kLostStart_s : 0.0))) {
    return SampleVerdict::kStarting;
  }
  // A restart keeps the field reference it has, a lost filter goes back to that of its start.
  Eigen::Vector3d field_tesla = Eigen::Vector3d::Zero();
  if (state_.lost) {
    field_tesla = state_.reference_tesla;
  } else if (start->has_field && core_.state().has_field == Scalar(0)) {
    field_tesla = ReferenceFor(start->mag_in_earth_tesla);
    state_.reference_tesla = field_tesla;
  }
  core_.Start(estimate.q_earth_sensor.template cast<Scalar>(), field_tesla.template cast<Scalar>(),
              estimate.started && !state_.lost);
  if (start->has_field) {
    DoubtHeading(start->mag_in_earth_tesla);
  }
  estimate.started = true;
  state_.starting = false;
  state_.lost = false;
  static_cast<void>(Report());
  return SampleVerdict::kFused;
}

// The first field that is seen says where north is: heading moves there at once.
template <typename Scalar>
void BoundedMotionFilter<Scalar>::AdoptField(const Eigen::Vector3d& mag_in_earth_tesla) {
  if (!(std::hypot(mag_in_earth_tesla.x(), mag_in_earth_tesla.y()) >
        1e-6 * mag_in_earth_tesla.norm())) {
    return;  // vertical: says nothing about heading
  }
  const double north_rad = std::atan2(mag_in_earth_tesla.x(), mag_in_earth_tesla.y());
  const Eigen::Quaterniond q_turn = math::ExpSO3({0.0, 0.0, north_rad});
  core_.TurnHeading(q_turn.template cast<Scalar>());
  state_.reference_tesla = ReferenceFor(mag_in_earth_tesla);
  core_.AdoptField(state_.reference_tesla.template cast<Scalar>());
  DoubtHeading(mag_in_earth_tesla);
}

// The session's field where it was measured, else what this sensor sees at its start.
template <typename Scalar>
Eigen::Vector3d BoundedMotionFilter<Scalar>::ReferenceFor(
    const Eigen::Vector3d& mag_in_earth_tesla) const {
  const BoundedMotionConfig& config = core_.config();
  if (config.reference_field_tesla > 0.0) {
    return config.reference_field_tesla * Eigen::Vector3d(0.0, std::cos(config.reference_dip_rad),
                                                          -std::sin(config.reference_dip_rad));
  }
  return ReferenceField(mag_in_earth_tesla);
}

// Whatever changes the session's field that much in length and upward part may have added as much
// sideways.
template <typename Scalar>
void BoundedMotionFilter<Scalar>::DoubtHeading(const Eigen::Vector3d& mag_in_earth_tesla) {
  if (!(core_.config().reference_field_tesla > 0.0)) {
    return;  // the start is the reference
  }
  const Eigen::Vector3d off_tesla = ReferenceField(mag_in_earth_tesla) - state_.reference_tesla;
  const double north_tesla = state_.reference_tesla.y();
  const double doubt_rad = north_tesla > 0.0 ? off_tesla.norm() / north_tesla : 0.0;
  core_.InflateHeading(static_cast<Scalar>(std::min(doubt_rad * doubt_rad, kAnyHeading_rad2)));
}

// One step, or over a gap several of the nominal length with the mean rate, of which only the last
// one has readings.
template <typename Scalar>
void BoundedMotionFilter<Scalar>::Feed() {
  const GatedSample& sample = gated_;
  BoundedMotionInput<Scalar> input = input_;
  const bool blind = sample.gyro_absent() && !sample.gyro_held;
  if (blind) {
    input.gyro_rad_s = core_.state().b_g;
  }
  double variance_rad2 = 0.0;
  int steps = 1;
  if (sample.gap) {
    variance_rad2 = kUnseenRate_rad_s * kUnseenRate_rad_s * sample.dt_s * sample.dt_s;
    const double nominal_s = std::max(state_.gate.state().nominal_dt_s, 1e-4);
    steps = std::clamp(static_cast<int>(std::ceil(sample.dt_s / nominal_s)), 1, kMostSubSteps);
  } else if (blind) {
    variance_rad2 = kUnseenRate_rad_s * kUnseenRate_rad_s * sample.dt_s;
  } else if (sample.gyro_saturated) {
    variance_rad2 =
        kSaturatedRateShare * kSaturatedRateShare * sample.gyro_rad_s.squaredNorm() * sample.dt_s;
  }
  core_.InflateAttitude(static_cast<Scalar>(variance_rad2));
  input.dt_s = static_cast<Scalar>(sample.dt_s / steps);
  input.accel_valid = Scalar(0);
  input.mag_valid = Scalar(0);
  for (int i = 1; i < steps; ++i) {
    core_.Update(input);
  }
  input.accel_valid = input_.accel_valid;
  input.mag_valid = input_.mag_valid;
  core_.Update(input);
}

template <typename Scalar>
SampleVerdict BoundedMotionFilter<Scalar>::Report() {
  const GatedSample& sample = gated_;
  FilterEstimate& estimate = state_.estimate;
  const BoundedMotionState<Scalar>& s = core_.state();
  const double lead_s = core_.config().output_lead_s;
  Eigen::Quaterniond q_ES = s.q_ES.template cast<double>();
  estimate.w_earth_sensor_in_sensor_rad_s = s.w_ES_S.template cast<double>();
  if (sample.accel_valid) {
    estimate.free_accel_in_earth_m_s2 = q_ES * (sample.accel_m_s2 - s.b_a.template cast<double>()) -
                                        Eigen::Vector3d(0.0, 0.0, kGravity_m_s2);
  } else {
    estimate.free_accel_in_earth_m_s2.setZero();
  }
  if (lead_s != 0.0) {
    q_ES = q_ES * math::ExpSO3(lead_s * estimate.w_earth_sensor_in_sensor_rad_s);
  }
  estimate.q_earth_sensor = math::NearestSign(q_ES, estimate.q_earth_sensor);
  estimate.gyro_bias_rad_s = s.b_g.template cast<double>();
  const Eigen::Vector3d late_rad =
      core_.config().sigma_time_s * (q_ES * estimate.w_earth_sensor_in_sensor_rad_s);
  estimate.cov_orientation_rad2 = AttitudeCovariance(s) + late_rad * late_rad.transpose();
  estimate.at_rest = core_.at_rest();
  const double mag_absent_s = state_.gate.mag_absent_s();
  const bool has_field = s.has_field > Scalar(0);
  const bool field_gone = !has_field || mag_absent_s > kMagneticUnusedAfter_s;
  const bool disturbed = static_cast<double>(s.deviation_hold) > kDisturbedAbove_ref;
  estimate.magnetic_state = field_gone  ? MagneticState::kUnused
                            : disturbed ? MagneticState::kDisturbed
                                        : MagneticState::kClean;
  estimate.heading = has_field && mag_absent_s <= kMagneticMemory_s ? HeadingReference::kMagnetic
                                                                    : HeadingReference::kArbitrary;
  estimate.degraded = sample.gap || sample.gyro_saturated || !sample.accel_valid ||
                      (sample.gyro_absent() && state_.gate.gyro_seen()) ||
                      (has_field && field_gone);
  CheckAttitude();
  return sample.accel_valid ? SampleVerdict::kFused : SampleVerdict::kPredictedOnly;
}

template class BoundedMotionFilter<double>;
template class BoundedMotionFilter<float>;

std::unique_ptr<OrientationFilter> MakeBoundedMotionFilter(const BoundedMotionConfig& config,
                                                           std::string_view name) {
  if (config.precision == Precision::kFloat) {
    return std::make_unique<BoundedMotionFilter<float>>(config, name);
  }
  return std::make_unique<BoundedMotionFilter<double>>(config, name);
}

}  // namespace limbcast::filters
