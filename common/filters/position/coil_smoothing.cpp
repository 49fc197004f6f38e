#include "common/filters/position/coil_smoothing.hpp"

#include <cmath>

#include "common/base/expects.hpp"

namespace limbcast::filters {
namespace {

using Index = CoilInertialIndex;

std::size_t FramesIn(double lag_s, double rate_hz) {
  Expects(lag_s > 0.0 && rate_hz > 0.0, "a lag and a rate");
  return static_cast<std::size_t>(std::ceil(lag_s * rate_hz)) + 2;
}

}  // namespace

CoilEstimate EstimateOf(const CoilInertialState& state, const CoilCovariance& P, Time measured_at,
                        bool valid) {
  CoilEstimate estimate;
  estimate.measured_at = measured_at;
  estimate.valid = valid;
  estimate.p_earth_m = state.p_earth_m;
  estimate.p_emitter_sensor_m = state.p_emitter_sensor_m();
  estimate.v_emitter_sensor_m_s = state.q_earth_emitter.conjugate() * state.v_earth_m_s;
  estimate.q_sensor_emitter = state.q_sensor_emitter();
  estimate.sigma_m = std::sqrt(P.topLeftCorner<3, 3>().trace());
  const auto cross = P.block<3, 3>(Index::kSensorTheta, Index::kEmitterTheta);
  const double var_rad2 = P.block<3, 3>(Index::kSensorTheta, Index::kSensorTheta).trace() +
                          P.block<3, 3>(Index::kEmitterTheta, Index::kEmitterTheta).trace() -
                          2.0 * cross.trace();
  estimate.sigma_rad = std::sqrt(std::max(0.0, var_rad2));
  return estimate;
}

CoilFixedLag::CoilFixedLag(double lag_s, double rate_hz)
    : lag_s_(lag_s), window_(3 * FramesIn(lag_s, rate_hz)), epochs_(FramesIn(lag_s, rate_hz)) {}

bool CoilFixedLag::Update(const CoilInertialFilter& filter, Time measured_at,
                          CoilEstimate& lagged) {
  newest_ = (newest_ + 1) % epochs_.size();
  count_ = std::min(count_ + 1, epochs_.size());
  Epoch& epoch = epochs_[newest_];
  epoch.measured_at = measured_at;
  epoch.valid = filter.phase() == CoilPhase::kTracking;
  epoch.state = filter.state();
  epoch.records = filter.records().size();
  const CoilEstimate now = EstimateOf(filter.state(), filter.covariance(), measured_at, true);
  epoch.sigma_m = now.sigma_m;
  epoch.sigma_rad = now.sigma_rad;
  for (const CoilRecord& record : filter.records()) {
    window_.Push(record, filter.covariance().topRows<kOutputs>());
  }
  if (!epoch.valid) {
    window_.Clear();
  }
  // The newest epoch old enough, and the records after it.
  std::size_t after = 0;
  for (std::size_t back = 0; back < count_; ++back) {
    const Epoch& e = epochs_[(newest_ + epochs_.size() - back) % epochs_.size()];
    if (ToSeconds(measured_at - e.measured_at) + 1e-9 >= lag_s_) {
      CoilInertialState state = e.state;
      if (e.valid && after < window_.size()) {
        CoilVector d = CoilVector::Zero();
        d.head<kOutputs>() = window_.Correction(after);
        state = Plus(state, d);
      }
      lagged = EstimateOf(state, CoilCovariance::Zero(), e.measured_at, e.valid);
      lagged.sigma_m = e.sigma_m;
      lagged.sigma_rad = e.sigma_rad;
      return true;
    }
    after += e.records;
  }
  return false;
}

void CoilIntervalSmoother::Add(const CoilInertialFilter& filter, Time measured_at) {
  epochs_.push_back({measured_at,
                     filter.phase() == CoilPhase::kTracking,
                     filter.state(),
                     filter.covariance(),
                     {filter.records().begin(), filter.records().end()}});
}

std::vector<CoilEstimate> CoilIntervalSmoother::Smooth() const {
  std::vector<CoilEstimate> estimates(epochs_.size());
  CoilVector lambda = CoilVector::Zero();
  CoilCovariance Lambda = CoilCovariance::Zero();
  for (std::size_t k = epochs_.size(); k-- > 0;) {
    const Epoch& epoch = epochs_[k];
    if (!epoch.valid) {
      lambda.setZero();
      Lambda.setZero();
    }
    const CoilCovariance P = epoch.P - epoch.P * Lambda * epoch.P;
    estimates[k] =
        EstimateOf(Plus(epoch.state, epoch.P * lambda), P, epoch.measured_at, epoch.valid);
    for (std::size_t i = epoch.records.size(); i-- > 0;) {
      StepBack(epoch.records[i], lambda);
      StepBack(epoch.records[i], Lambda);
    }
  }
  return estimates;
}

}  // namespace limbcast::filters
