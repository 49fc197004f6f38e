#include "common/filters/sample_gate.hpp"

#include <algorithm>
#include <limits>

#include "common/base/time.hpp"
#include "common/filters/filter_constants.hpp"

namespace limbcast::filters {
namespace {

using sensing::MargFlag;

constexpr double kFirstNominal_s = 1.0;          // slower first steps are taken for a gap
constexpr std::uint32_t kNominalAverage = 32;    // steps
constexpr std::uint32_t kRunThatMovesTime = 20;  // old but ordered samples before time jumps back
constexpr double kGapTeachesNominal = 1.02;      // a lower rate is learned from its "gaps"

// Finite and small enough to be a reading; false for NaN by the order of the comparison.
bool Plausible(const Eigen::Vector3d& v, double limit) { return v.squaredNorm() <= limit * limit; }

double SecondsBetween(std::int64_t later_ns, std::int64_t earlier_ns) {
  // Unsigned: cannot overflow for any two times, and later ≥ earlier at every call.
  return 1e-9 * static_cast<double>(static_cast<std::uint64_t>(later_ns) -
                                    static_cast<std::uint64_t>(earlier_ns));
}

}  // namespace

double SampleGate::mag_absent_s() const {
  return state_.mag_seen ? state_.mag_absent_s : std::numeric_limits<double>::infinity();
}

SampleVerdict SampleGate::CheckTime(std::int64_t now_ns, GatedSample& out) {
  out.restart = !state_.has_time;
  if (!state_.has_time) {
    return SampleVerdict::kFused;
  }
  if (now_ns == state_.last_ns) {
    return SampleVerdict::kRejectedDuplicate;
  }
  if (now_ns < state_.last_ns) {
    const bool ordered = state_.rejected_run > 0 && now_ns > state_.rejected_ns;
    state_.rejected_run = ordered ? state_.rejected_run + 1 : 1;
    state_.rejected_ns = now_ns;
    if (state_.rejected_run < kRunThatMovesTime) {
      return SampleVerdict::kRejectedOutOfOrder;
    }
    out.restart = true;
    return SampleVerdict::kFused;
  }
  out.dt_s = SecondsBetween(now_ns, state_.last_ns);
  if (state_.steps == 0) {
    out.restart = out.dt_s > kGapFactor * kFirstNominal_s;
  } else if (out.dt_s > kGapFactor * state_.nominal_dt_s) {
    out.restart = out.dt_s > kMaxBridgedGap_s;
    out.gap = !out.restart;
  }
  return SampleVerdict::kFused;
}

void SampleGate::LearnNominal(double dt_s, bool gap) {
  if (state_.steps == 0) {
    state_.nominal_dt_s = std::min(dt_s, kFirstNominal_s);
    state_.steps = 1;
  } else if (gap) {
    state_.nominal_dt_s *= kGapTeachesNominal;
  } else {
    state_.steps = std::min(state_.steps + 1, kNominalAverage);
    const double gain =
        state_.steps == kNominalAverage ? 1.0 / kNominalAverage : 1.0 / state_.steps;
    state_.nominal_dt_s += gain * (dt_s - state_.nominal_dt_s);
  }
}

void SampleGate::FillGyro(bool measured, const Eigen::Vector3d& gyro_rad_s, GatedSample& out) {
  out.gyro_measured = measured;
  if (measured) {
    out.gyro_rad_s =
        out.gap && state_.gyro_seen ? 0.5 * (gyro_rad_s + state_.last_gyro_rad_s) : gyro_rad_s;
    state_.last_gyro_rad_s = gyro_rad_s;
    state_.gyro_seen = true;
    state_.gyro_absent_s = 0.0;
    return;
  }
  state_.gyro_absent_s += out.dt_s;
  if (state_.gyro_seen && !out.restart && state_.gyro_absent_s <= kMaxGyroHold_s) {
    out.gyro_rad_s = state_.last_gyro_rad_s;
    out.gyro_held = true;
  }
}

void SampleGate::Pass(const sensing::MargSample& sample, GatedSample& out) {
  out = GatedSample();
  constexpr std::uint32_t kAllMissing =
      MargFlag::kGyroMissing | MargFlag::kAccelMissing | MargFlag::kMagMissing;
  if (sample.Has(MargFlag::kProbe) || (sample.flags & kAllMissing) == kAllMissing) {
    return;
  }
  const Eigen::Vector3d gyro_rad_s = sample.gyro_rad_s.cast<double>();
  out.accel_m_s2 = sample.accel_m_s2.cast<double>();
  out.mag_tesla = sample.mag_tesla.cast<double>();
  const bool gyro_finite = Plausible(gyro_rad_s, kMaxPlausibleRate_rad_s);
  const bool accel_finite = Plausible(out.accel_m_s2, kMaxPlausibleForce_m_s2);
  const bool mag_finite = Plausible(out.mag_tesla, kMaxPlausibleField_tesla);
  const bool gyro_usable = gyro_finite && !sample.Has(MargFlag::kGyroMissing);
  out.gyro_saturated = gyro_usable && sample.Has(MargFlag::kGyroSaturated);
  out.accel_valid = accel_finite &&
                    (sample.flags & (MargFlag::kAccelMissing | MargFlag::kAccelSaturated)) == 0 &&
                    out.accel_m_s2.squaredNorm() >= kMinSpecificForce_m_s2 * kMinSpecificForce_m_s2;
  out.mag_valid = mag_finite && out.mag_tesla.squaredNorm() > 0.0 &&
                  (sample.flags & (MargFlag::kMagMissing | MargFlag::kMagSaturated |
                                   MargFlag::kCoilPulseActive)) == 0;
  if (!gyro_usable && !out.accel_valid && !out.mag_valid) {
    out.verdict = gyro_finite && accel_finite && mag_finite ? SampleVerdict::kRejectedSaturated
                                                            : SampleVerdict::kRejectedNotFinite;
    return;
  }
  const std::int64_t now_ns = ToNanoseconds(sample.measured_at);
  out.verdict = CheckTime(now_ns, out);
  if (!out.usable()) {
    return;
  }
  if (state_.has_time && out.dt_s > 0.0) {
    LearnNominal(out.dt_s, out.gap || out.restart);
  }
  if (out.restart) {
    out.dt_s = 0.0;
  }
  FillGyro(gyro_usable, gyro_rad_s, out);
  state_.mag_absent_s = out.mag_valid ? 0.0 : state_.mag_absent_s + out.dt_s;
  state_.mag_seen = state_.mag_seen || out.mag_valid;
  state_.has_time = true;
  state_.last_ns = now_ns;
  state_.rejected_run = 0;
}

}  // namespace limbcast::filters
