#include "common/filters/position/coil_pulse_planner.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "common/base/range.hpp"
#include "common/filters/position/coil_measurement.hpp"

namespace limbcast::filters {
namespace {

using Index = CoilInertialIndex;

constexpr double kMostOfRange = 0.8;
constexpr double kPulsesSaved = 3.0;

// cov(θ_s − θ_m) of a covariance, or of what an update takes away from one.
Eigen::Matrix3d Relative(const CoilCovariance& P) {
  constexpr int s = Index::kSensorTheta;
  constexpr int m = Index::kEmitterTheta;
  return P.block<3, 3>(s, s) + P.block<3, 3>(m, m) - P.block<3, 3>(s, m) - P.block<3, 3>(m, s);
}

}  // namespace

Status Validate(const CoilPlannerConfig& c) {
  return CheckRanges("coil planner: ", {{"sigma_p_m", c.sigma_p_m, 1e-4, 1.0},
                                        {"sigma_theta_rad", c.sigma_theta_rad, 1e-3, 1.0},
                                        {"pulse_s", c.pulse_s, 0.01, 1.0},
                                        {"gap_s", c.gap_s, 0.01, 1.0},
                                        {"samples", static_cast<double>(c.samples), 1.0, 1000.0},
                                        {"max_duty", c.max_duty, 0.01, 0.9},
                                        {"longest_pause_s", c.longest_pause_s, 0.1, 60.0},
                                        {"current_a", c.current_a, 1e-6, 20.0},
                                        {"mag_range_tesla", c.mag_range_tesla, 1e-9, 1.0}});
}

Result<CoilPulsePlanner> CoilPulsePlanner::Make(const CoilPlannerConfig& config,
                                                const CoilInertialConfig& filter) {
  if (const Status valid = Validate(config); !valid) {
    return valid.error();
  }
  if (const Status valid = Validate(filter); !valid) {
    return valid.error();
  }
  return CoilPulsePlanner(config, filter);
}

bool CoilPulsePlanner::Wanted(Time now, const CoilInertialFilter& filter) const {
  if (filter.phase() != CoilPhase::kTracking || !pulsed_at_ ||
      ToSeconds(now - *pulsed_at_) >= config_.longest_pause_s) {
    return true;
  }
  const CoilCovariance& P = filter.covariance();
  return std::sqrt(P.block<3, 3>(Index::kP, Index::kP).trace()) > config_.sigma_p_m ||
         std::sqrt(Relative(P).trace()) > config_.sigma_theta_rad;
}

// The coil whose pulse takes most away; its current.
CoilPulsePlanner::Pulse CoilPulsePlanner::Best(const CoilInertialFilter& filter) const {
  const CoilCovariance& P = filter.covariance();
  const CoilInertialState& state = filter.state();
  const Eigen::Matrix3d R = sigma_mag_tesla_ * sigma_mag_tesla_ /
                            static_cast<double>(config_.samples) * Eigen::Matrix3d::Identity();
  const double room_tesla =
      kMostOfRange * config_.mag_range_tesla - state.background_earth_tesla.norm();
  Pulse best;
  double most = -1.0;
  for (int coil = 0; coil < 3; ++coil) {
    sensing::CoilDrive drive;
    drive.coil = coil;
    drive.current_a = config_.current_a;
    CoilPrediction predicted = PredictCoilSample(source_, drive, state);
    if (predicted.coil_tesla > room_tesla) {
      drive.current_a *= std::max(0.0, room_tesla) / predicted.coil_tesla;
      predicted = PredictCoilSample(source_, drive, state);
    }
    // P − P⁺ = P Hᵀ (H P Hᵀ + R)⁻¹ H P
    const Eigen::Matrix<double, 3, Index::kAll> HP = predicted.H * P;
    const Eigen::Matrix3d S = HP * predicted.H.transpose() + R;
    const CoilCovariance less = HP.transpose() * S.llt().solve(HP);
    const double gain =
        less.block<3, 3>(Index::kP, Index::kP).trace() / (config_.sigma_p_m * config_.sigma_p_m) +
        Relative(less).trace() / (config_.sigma_theta_rad * config_.sigma_theta_rad);
    if (gain > most) {
      most = gain;
      best = {coil, drive.current_a};
    }
  }
  return best;
}

std::optional<CoilPulsePlanner::Pulse> CoilPulsePlanner::Next(Time now,
                                                              const CoilInertialFilter& filter,
                                                              bool may_pulse) {
  if (!first_at_) {
    first_at_ = now;
    saved_s_ = kPulsesSaved * config_.pulse_s;
  }
  if (asked_at_) {
    saved_s_ = std::min(kPulsesSaved * config_.pulse_s,
                        saved_s_ + config_.max_duty * ToSeconds(now - *asked_at_));
  }
  asked_at_ = now;
  const bool background_seen =
      !pulsed_at_ || ToSeconds(now - *pulsed_at_) >= config_.pulse_s + config_.gap_s;
  if (!may_pulse || !background_seen || saved_s_ < config_.pulse_s ||
      filter.phase() == CoilPhase::kLevelling || !Wanted(now, filter)) {
    return std::nullopt;
  }
  Pulse pulse;
  if (filter.phase() == CoilPhase::kTracking) {
    pulse = Best(filter);
  } else {
    pulse = {turn_, config_.current_a};
    turn_ = (turn_ + 1) % 3;
  }
  pulsed_at_ = now;
  saved_s_ -= config_.pulse_s;
  on_s_ += config_.pulse_s;
  return pulse;
}

double CoilPulsePlanner::Duty(Time now) const {
  if (!first_at_ || now <= *first_at_) {
    return 0.0;
  }
  return on_s_ / ToSeconds(now - *first_at_);
}

}  // namespace limbcast::filters
