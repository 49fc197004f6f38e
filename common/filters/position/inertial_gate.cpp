#include "common/filters/position/inertial_gate.hpp"

#include <algorithm>
#include <cmath>

#include "common/filters/filter_constants.hpp"

namespace limbcast::filters {
namespace {

constexpr double kGapSteps = 2.5;      // a longer step than so many nominal ones is a dropout
constexpr double kNominalGain = 0.05;  // how fast the nominal step is learned
constexpr double kGapTeaches = 1.02;   // a lower rate is learned from its "dropouts"

bool Plausible(const InertialReading& r) {
  return r.gyro_rad_s.squaredNorm() <= kMaxPlausibleRate_rad_s * kMaxPlausibleRate_rad_s &&
         r.accel_m_s2.squaredNorm() <= kMaxPlausibleForce_m_s2 * kMaxPlausibleForce_m_s2;
}

}  // namespace

bool InertialGate::Saturated(const sensing::MargSample& sample,
                             const InertialReading& reading) const {
  const auto beyond = [](const Eigen::Vector3d& v, double range) {
    return range > 0.0 && v.cwiseAbs().maxCoeff() > kSaturatedAt * range;
  };
  return sample.Has(sensing::kGyroSaturated) || sample.Has(sensing::kAccelSaturated) ||
         beyond(reading.accel_m_s2, accel_range_m_s2_) ||
         beyond(reading.gyro_rad_s, gyro_range_rad_s_);
}

GatedInertial InertialGate::Pass(const sensing::MargSample& sample) {
  GatedInertial out;
  if (sample.Has(sensing::kProbe)) {
    return out;
  }
  out.reading = {sample.gyro_rad_s.cast<double>(), sample.accel_m_s2.cast<double>()};
  const bool missing = sample.Has(sensing::kGyroMissing) || sample.Has(sensing::kAccelMissing);
  const bool good = !missing && Plausible(out.reading);
  if (!has_time_) {
    if (!good) {
      out.verdict = missing ? SampleVerdict::kNoData : SampleVerdict::kRejectedNotFinite;
      return out;
    }
    out.verdict = SampleVerdict::kFused;
    out.first = true;
    has_time_ = true;
    last_passed_at_ = last_good_at_ = sample.measured_at;
    last_ = out.reading;
    return out;
  }
  if (sample.measured_at <= last_passed_at_) {
    out.verdict = sample.measured_at == last_passed_at_ ? SampleVerdict::kRejectedDuplicate
                                                        : SampleVerdict::kRejectedOutOfOrder;
    return out;
  }
  out.dt_s = ToSeconds(sample.measured_at - last_passed_at_);
  const double unseen_s = ToSeconds(sample.measured_at - last_good_at_);
  if (!good) {
    if (unseen_s > kMaxHold_s) {  // the next good reading tells of the dropout
      out.verdict = missing ? SampleVerdict::kNoData : SampleVerdict::kRejectedNotFinite;
      return out;
    }
    out.verdict = SampleVerdict::kPredictedOnly;
    out.reading = last_;
    out.noise_factor = kHoldNoise;
    last_passed_at_ = sample.measured_at;
    return out;
  }
  out.verdict = SampleVerdict::kFused;
  const bool gap = nominal_dt_s_ > 0.0 && unseen_s > kGapSteps * nominal_dt_s_;
  out.long_dropout = gap && unseen_s > kMaxHold_s;
  out.noise_factor = gap ? kHoldNoise : 1.0;
  const bool saturated = Saturated(sample, out.reading);
  if (saturated || was_saturated_) {
    out.noise_factor = std::max(out.noise_factor, kSaturationNoise);
  }
  was_saturated_ = saturated;
  if (nominal_dt_s_ == 0.0) {
    nominal_dt_s_ = out.dt_s;
  } else if (gap) {
    nominal_dt_s_ *= kGapTeaches;
  } else {
    nominal_dt_s_ += kNominalGain * (out.dt_s - nominal_dt_s_);
  }
  last_passed_at_ = last_good_at_ = sample.measured_at;
  last_ = out.reading;
  return out;
}

}  // namespace limbcast::filters
