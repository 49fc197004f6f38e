#include "services/fusion/coil_track.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/base/expects.hpp"
#include "common/math/rotation.hpp"
#include "common/sensing/coil_flags.hpp"

namespace limbcast::fusion {
namespace {

using Index = filters::CoilInertialIndex;

constexpr std::uint32_t kMagUseless =
    sensing::kMagMissing | sensing::kMagSaturated | sensing::kMagHeld;
constexpr std::uint32_t kInertialMissing = sensing::kGyroMissing | sensing::kAccelMissing;
constexpr std::uint32_t kInertialSaturated = sensing::kGyroSaturated | sensing::kAccelSaturated;

filters::CoilBothSides MakeValid(const filters::CoilInertialConfig& config) {
  auto made = filters::CoilBothSides::Make(config);
  Expects(made.ok(), "a validated coil filter");
  return *made;
}

// What is not there is NaN: the filter then holds what it had.
Eigen::Vector3d OrNaN(const Eigen::Vector3f& reading, bool there) {
  return there ? Eigen::Vector3d(reading.cast<double>())
               : Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace

CoilTrack::Lag::Lag(double lag_s)
    : smoother(lag_s, kHighestLagRate_hz),
      axes(static_cast<std::size_t>(std::ceil(lag_s * kHighestLagRate_hz)) + 2) {}

CoilTrack::CoilTrack(const CoilAidConfig& config, double lag_s)
    : current_a_(config.current_a), filter_(MakeValid(config.filter)) {
  if (lag_s > 0.0) {
    lag_.emplace(lag_s);
  }
}

std::optional<LaggedPosition> CoilTrack::Lagged() {
  if (!lag_ || !std::exchange(lag_->pending, false)) {
    return std::nullopt;
  }
  if (!filter_.valid()) {
    lag_->smoother.Clear();
    return std::nullopt;
  }
  filters::CoilEstimate estimate;
  const Time measured_at = lag_->axes[lag_->newest].at;
  if (!lag_->smoother.Update(filter_.filter(), measured_at, estimate) || !estimate.valid) {
    return std::nullopt;
  }
  const auto then = std::find_if(lag_->axes.begin(), lag_->axes.end(),
                                 [&](const Axes& one) { return one.at == estimate.measured_at; });
  if (then == lag_->axes.end()) {
    return std::nullopt;
  }
  const Eigen::Quaterniond& q = then->q_earth_source;
  return LaggedPosition{.measured_at = estimate.measured_at,
                        .q_earth_sensor = q * estimate.q_sensor_emitter.conjugate(),
                        .position = {.p_earth_sensor_m = q * estimate.p_emitter_sensor_m,
                                     .v_earth_sensor_m_s = q * estimate.v_emitter_sensor_m_s,
                                     .cov_position_m2 = estimate.sigma_m * estimate.sigma_m / 3.0 *
                                                        Eigen::Matrix3d::Identity(),
                                     .fill = FillKind::kInertialSmoothed}};
}

std::optional<SegmentPosition> CoilTrack::Update(const sensing::MargSample& sample,
                                                 const sensing::MargSample& source,
                                                 const Eigen::Quaterniond& q_earth_source) {
  const double apart_s = ToSeconds(source.measured_at - sample.measured_at);
  const bool together = std::abs(apart_s) <= kMostApart_s;
  const bool sensor_there = (sample.flags & kInertialMissing) == 0;
  const bool source_there = together && (source.flags & kInertialMissing) == 0;
  sensing::CoilFrame frame;
  frame.measured_at = sample.measured_at;
  frame.gyro_rad_s = OrNaN(sample.gyro_rad_s, sensor_there);
  frame.accel_m_s2 = OrNaN(sample.accel_m_s2, sensor_there);
  frame.mag_tesla = sample.mag_tesla.cast<double>();
  frame.mag_valid = (sample.flags & kMagUseless) == 0;
  frame.inertial_saturated = ((sample.flags | source.flags) & kInertialSaturated) != 0;
  frame.emitter_gyro_rad_s = OrNaN(source.gyro_rad_s, source_there);
  frame.emitter_accel_m_s2 = OrNaN(source.accel_m_s2, source_there);
  // Of its own instant: a pulse may have begun between the two samples.
  const sensing::CoilDrive at_source = sensing::CoilDriveOf(source.flags, current_a_);
  const Eigen::Vector3d turned_rad = -apart_s * source.gyro_rad_s.cast<double>();
  frame.emitter_mag_tesla = math::ExpSO3(turned_rad).conjugate() * source.mag_tesla.cast<double>();
  frame.emitter_mag_valid =
      source_there && (source.flags & kMagUseless) == 0 && at_source.coil < 0 && at_source.settled;
  frame.drive = sensing::CoilDriveOf(sample.flags, current_a_);
  const filters::CoilUpdateReport report = filter_.Update(frame);
  if (lag_ && report.verdict != filters::CoilFrameVerdict::kRejectedOutOfOrder) {
    lag_->newest = (lag_->newest + 1) % lag_->axes.size();
    lag_->axes[lag_->newest] = {.at = frame.measured_at, .q_earth_source = q_earth_source};
    lag_->pending = true;
  }
  if (!filter_.valid() || report.verdict == filters::CoilFrameVerdict::kRejectedOutOfOrder) {
    return std::nullopt;
  }
  const filters::CoilInertialState& state = filter_.filter().state();
  const filters::CoilCovariance& P = filter_.filter().covariance();
  // From the filter's earth frame, whose heading is its own, into that of the orientation filter:
  // p = R R_mᵀ p' , so δp = R R_mᵀ (δp' + [p']× θ_m).
  const Eigen::Matrix3d R = (q_earth_source * state.q_earth_emitter.conjugate()).toRotationMatrix();
  Eigen::Matrix<double, 3, 6> J;
  J << R, R * math::Skew(state.p_earth_m);
  Eigen::Matrix<double, 6, 6> P_pm;
  P_pm << P.block<3, 3>(Index::kP, Index::kP), P.block<3, 3>(Index::kP, Index::kEmitterTheta),
      P.block<3, 3>(Index::kEmitterTheta, Index::kP),
      P.block<3, 3>(Index::kEmitterTheta, Index::kEmitterTheta);
  SegmentPosition position;
  position.p_earth_sensor_m = R * state.p_earth_m;
  position.v_earth_sensor_m_s = R * state.v_earth_m_s;
  position.cov_position_m2 = J * P_pm * J.transpose();
  const bool pulse = frame.drive.coil >= 0 && frame.drive.settled &&
                     report.verdict == filters::CoilFrameVerdict::kUsed;
  position.fill = pulse ? FillKind::kMeasured : FillKind::kInertialForward;
  return position;
}

}  // namespace limbcast::fusion
