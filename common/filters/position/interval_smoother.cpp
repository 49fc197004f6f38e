#include "common/filters/position/interval_smoother.hpp"

#include "common/base/expects.hpp"

namespace limbcast::filters {

using namespace optical;

void OpticalHistory::Reserve(std::size_t epochs) {
  stored_.reserve(epochs);
  forward_.reserve(epochs);
}

void OpticalHistory::Push(const OpticalEpoch& epoch) {
  if (epoch.record.chain_begins) {
    chains_.push_back({stored_.size(), epoch.state, epoch.P});
  }
  stored_.push_back({epoch.record, OutputRowsOf(epoch)});
  forward_.push_back(ForwardEstimate(epoch));
}

std::vector<PositionEstimate> OpticalHistory::Smooth() const {
  std::vector<PositionEstimate> out = forward_;
  ErrorVector lambda = ErrorVector::Zero();
  Covariance Lambda = Covariance::Zero();
  bool later_marker = false;
  for (std::size_t i = out.size(); i-- > 0;) {
    const Stored& stored = stored_[i];
    PositionEstimate& estimate = out[i];
    Correct(stored.rows * lambda, estimate);
    const auto marker_rows = stored.rows.middleRows<3>(kOutMarker);
    estimate.cov_position_m2 -= marker_rows * Lambda * marker_rows.transpose();
    if (estimate.fill == FillKind::kInertialForward && later_marker) {
      estimate.fill = FillKind::kInertialSmoothed;
    }
    later_marker = later_marker || estimate.fill == FillKind::kMeasured;
    later_marker = later_marker && !stored.record.chain_begins;
    StepBack(stored.record, lambda);
    StepBack(stored.record, Lambda);
  }
  return out;
}

OpticalInertialState OpticalHistory::SmoothedStart() const {
  Expects(!chains_.empty(), "a history that has begun");
  const Chain& chain = chains_.front();
  const std::size_t end = chains_.size() > 1 ? chains_[1].first : stored_.size();
  ErrorVector lambda = ErrorVector::Zero();
  for (std::size_t i = end - 1; i > chain.first; --i) {
    StepBack(stored_[i].record, lambda);
  }
  OpticalInertialState state = chain.state;
  Inject(chain.P * lambda, state);
  return state;
}

}  // namespace limbcast::filters
