#include <algorithm>
#include <cmath>

#include "common/filters/position/coil_inertial_filter.hpp"
#include "common/filters/position/coil_measurement.hpp"

namespace limbcast::filters {

// What else an instant says, beside the sensor's magnetometer.

namespace {

// Gauges say little, and always something.
constexpr SoftGateConfig kNoGate{.downweight_above_nis = 1e12, .reject_above_nis = 1e12};

}  // namespace

MeasurementRecord<CoilInertialIndex::kAll, 3>& CoilInertialFilter::Further() {
  CoilRecord& record = records_[record_count_];
  record.chain_begins = false;
  record.stays = true;
  return record.measurement;
}

void CoilInertialFilter::UseFurther(const SoftGateConfig& gate, double sigma) {
  auto& measurement = records_[record_count_].measurement;
  SoftUpdate(gate, Eigen::Matrix3d(sigma * sigma * Eigen::Matrix3d::Identity()), false, P_,
             measurement);
  if (measurement.fused) {
    state_ = Plus(state_, measurement.K * measurement.nu);
  }
  ++record_count_;
}

// Between pulses the source's compass ties its heading to the field that the sensor feels, which
// the gradient carries from one to the other.
void CoilInertialFilter::UseEmitterSample(const sensing::CoilFrame& frame) {
  if (frame.drive.coil >= 0 || !frame.drive.settled) {
    source_on_at_ = frame.measured_at;
  }
  if (!config_.estimate_gradient || !frame.HasEmitterField() ||
      ToSeconds(frame.measured_at - source_on_at_) < config_.emitter_quiet_s) {
    return;
  }
  PredictEmitterSample(state_, frame.emitter_mag_tesla, Further());
  UseFurther(config_.gate, config_.sigma_mag_tesla);
}

// Of one sample in each period, which stands for those between; not for those of a dropout.
double CoilInertialFilter::SigmaGravity_m_s2() const {
  constexpr double kSample_s = 1.0 / 120.0;  // the deviation is stated for one such sample
  return config_.sigma_gravity_m_s2 *
         std::sqrt(std::min(1.0, kSample_s / std::max(config_.gravity_period_s, kSample_s)));
}

void CoilInertialFilter::UseGauges(const sensing::CoilFrame& frame) {
  if (frame.emitter_inertial &&
      ToSeconds(frame.measured_at - gravity_at_) >= config_.gravity_period_s) {
    GravityGauge(state_, frame.emitter_accel_m_s2, Further());
    UseFurther(kNoGate, SigmaGravity_m_s2());
    gravity_at_ = frame.measured_at;
  }
  if (ToSeconds(frame.measured_at - background_at_) >= config_.background_period_s) {
    BackgroundGauge(state_, background_start_tesla_, Further());
    UseFurther(kNoGate, config_.sigma_background_tesla);
    background_at_ = frame.measured_at;
  }
}

}  // namespace limbcast::filters
