#include "services/fusion/sensor_track.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "common/base/expects.hpp"
#include "common/math/rotation.hpp"
#include "common/units/frames.hpp"
#include "common/units/units.hpp"

namespace limbcast::fusion {

namespace {

using body::SegmentState;

constexpr std::uint32_t kRunThatMovesTime = 20;  // old samples before time jumps back
constexpr double kMaxNormError = 0.05;  // of a quaternion from outside, before it is normalised

std::unique_ptr<filters::OrientationFilter> MakeChosen(const FilterFactory& factory,
                                                       const std::string& name) {
  auto filter = factory(name);
  Expects(filter.ok(), "a filter name that was checked before it was chosen");
  return std::move(*filter);
}

// False for NaN and Inf too, by the order of the comparisons.
bool IsUsable(const sensing::FusedOrientation& orientation) {
  const double norm = orientation.q_earth_sensor.norm();
  return norm >= 1.0 - kMaxNormError && norm <= 1.0 + kMaxNormError;
}

}  // namespace

SensorTrack::SensorTrack(BodyId body_id, const TrackPlan& plan, const FilterFactory& factory,
                         Duration max_future, double declination_rad)
    : body_id_(body_id),
      max_future_(max_future),
      q_true_magnetic_(
          units::TrueFromMagneticNorth(Eigen::Quaterniond::Identity(), declination_rad)),
      has_declination_(declination_rad != 0.0),
      plan_(plan),
      filter_(MakeChosen(factory, plan.filters.name)),
      beside_(plan.filters.beside.empty() ? nullptr : MakeChosen(factory, plan.filters.beside)),
      overloads_seen_(plan.overloads) {
  ProvideSlots(filter_slots());
}

void SensorTrack::ProvideSlots(std::size_t count) {
  while (states_.size() < count) {
    SegmentState& state = states_.emplace_back();
    state.body_id = body_id_;
    state.slot = static_cast<std::uint8_t>(states_.size() - 1);
    state.sensor_uid = plan_.sensor_uid;
    state.filter.reserve(16);  // bound of the wire type: no allocation later
  }
}

void SensorTrack::Apply(const TrackPlan& plan, const FilterFactory& factory) {
  const FilterChoice before = std::exchange(plan_, plan).filters;
  if (plan.filters.name != before.name) {
    incoming_.reset();
    if (filter_->name() == plan.filters.name) {
      // Chosen back before the other one was ready.
    } else if (beside_ != nullptr && before.beside == plan.filters.name) {
      std::swap(filter_, beside_);
      beside_.reset();
    } else {
      incoming_ = MakeChosen(factory, plan.filters.name);
      TakeIncoming();
    }
  }
  const bool beside_is_right = plan.filters.beside.empty()
                                   ? beside_ == nullptr
                                   : beside_ != nullptr && before.beside == plan.filters.beside;
  if (!beside_is_right) {
    beside_ = plan.filters.beside.empty() ? nullptr : MakeChosen(factory, plan.filters.beside);
  }
  ProvideSlots(filter_slots());
}

// Without an orientation so far there is nothing to hold on to.
void SensorTrack::TakeIncoming() {
  if (incoming_ != nullptr && (incoming_->estimate().started || !filter_->estimate().started)) {
    filter_ = std::move(incoming_);
  }
}

SequenceTracker::Arrival SensorTrack::Arrive(Source& source, std::uint32_t sequence,
                                             Time measured_at, const Reception& reception,
                                             std::int64_t& lost) {
  const SequenceTracker::Arrival arrival = source.sequence.Arrive(sequence, measured_at);
  // Samples refused for a full queue came, and are missing from the numbers all the same.
  const std::uint64_t refused = reception.overloads - overloads_seen_;
  overloads_seen_ = reception.overloads;
  source.verdicts.count[static_cast<std::size_t>(SampleVerdict::kRejectedOverload)] += refused;
  lost = arrival.lost > 0
             ? std::max<std::int64_t>(arrival.lost - static_cast<std::int64_t>(refused), 0)
             : arrival.lost;
  lost = std::max(lost, -source.lost);  // never below nothing
  source.lost += lost;
  return arrival;
}

SampleVerdict SensorTrack::CheckTime(Time measured_at, const Reception& reception) const {
  const bool possible = measured_at > Time{} && measured_at - reception.received_at <= max_future_;
  return possible ? SampleVerdict::kFused : SampleVerdict::kRejectedTime;
}

// What filters do for raw samples (filters/sample_gate): time goes forward, and when it does not
// for long, the old time was wrong.
SampleVerdict SensorTrack::CheckOrder(Time measured_at) {
  if (onboard_used_at_ && measured_at == *onboard_used_at_) {
    return SampleVerdict::kRejectedDuplicate;
  }
  if (onboard_used_at_ && measured_at < *onboard_used_at_ &&
      ++onboard_old_run_ < kRunThatMovesTime) {
    return SampleVerdict::kRejectedOutOfOrder;
  }
  onboard_old_run_ = 0;
  onboard_used_at_ = measured_at;
  return SampleVerdict::kFused;
}

void SensorTrack::Start(SegmentState& state, std::uint32_t sequence, Time measured_at,
                        Time gateway_published_at, const Reception& reception) const {
  state.segment = plan_.segment;
  state.sequence = sequence;
  state.measured_at = measured_at;
  state.stages = {.gateway_published_at = gateway_published_at,
                  .fusion_received_at = reception.received_at};
}

void SensorTrack::Fill(SegmentState& state, const filters::OrientationFilter& filter) const {
  const filters::FilterEstimate& estimate = filter.estimate();
  state.started = estimate.started;
  state.degraded = estimate.degraded;
  state.at_rest = estimate.at_rest;
  state.magnetic_state = estimate.magnetic_state;
  state.heading = estimate.heading;
  state.q_earth_sensor = math::Canonical(estimate.q_earth_sensor);
  state.w_earth_sensor_in_sensor_rad_s = estimate.w_earth_sensor_in_sensor_rad_s.cast<float>();
  state.free_accel_in_earth_m_s2 = estimate.free_accel_in_earth_m_s2.cast<float>();
  state.cov_orientation_rad2 = estimate.cov_orientation_rad2.cast<float>();
  state.filter = filter.name();
  if (has_declination_) {
    TurnToTrueNorth(state);
  }
}

// Always, so that a heading that is held without a field does not jump; only one with a field is
// called true.
void SensorTrack::TurnToTrueNorth(SegmentState& state) const {
  const Eigen::Matrix3f R_true_magnetic = q_true_magnetic_.toRotationMatrix().cast<float>();
  state.q_earth_sensor = math::Canonical(q_true_magnetic_ * state.q_earth_sensor);
  state.free_accel_in_earth_m_s2 = R_true_magnetic * state.free_accel_in_earth_m_s2;
  state.cov_orientation_rad2 =
      R_true_magnetic * state.cov_orientation_rad2 * R_true_magnetic.transpose();
  if (state.heading == HeadingReference::kMagnetic) {
    state.heading = HeadingReference::kTrue;
  }
}

void SensorTrack::Count(SegmentState& state, const Source& source, SampleVerdict verdict) {
  state.verdict = verdict;
  state.verdicts = source.verdicts;
  state.lost_count = static_cast<std::uint64_t>(source.lost);
}

void SensorTrack::Submit(const FilterPtr& filter, const sensing::MargSample& sample) {
  if (filter != nullptr && filter->batched() != nullptr) {
    filter->batched()->Submit(sample);
  }
}

SampleVerdict SensorTrack::Take(const FilterPtr& filter, const sensing::MargSample& sample) {
  return filter->batched() != nullptr ? filter->batched()->Take() : filter->Update(sample);
}

SensorTrack::Output SensorTrack::Update(const sensing::MargSample& sample,
                                        const Reception& reception) {
  Judge(sample, reception);
  return Answer(sample, [&sample](const FilterPtr& filter) { return filter->Update(sample); });
}

void SensorTrack::Begin(const sensing::MargSample& sample, const Reception& reception) {
  Expects(begun_ == nullptr, "Finish before the next Begin");
  begun_ = &sample;
  Judge(sample, reception);
  if (output_.verdict == SampleVerdict::kFused) {
    Submit(filter_, sample);
    Submit(beside_, sample);
    Submit(incoming_, sample);
  }
}

SensorTrack::Output SensorTrack::Finish() {
  const sensing::MargSample& sample = *std::exchange(begun_, nullptr);
  return Answer(sample, [&sample](const FilterPtr& filter) { return Take(filter, sample); });
}

// Counts the sample and says whether the filters get it: verdict kFused.
void SensorTrack::Judge(const sensing::MargSample& sample, const Reception& reception) {
  output_ = Output{.states = {states_.data(), filter_slots()}};
  for (SegmentState& state : output_.states) {
    Start(state, sample.sequence, sample.measured_at, sample.published_at, reception);
  }
  if (sample.Has(sensing::MargFlag::kProbe)) {
    output_.probe = true;
    return;
  }
  marg_seen_ = true;
  const auto arrival = Arrive(marg_, sample.sequence, sample.measured_at, reception, output_.lost);
  output_.verdict = arrival.duplicate ? SampleVerdict::kRejectedDuplicate
                                      : CheckTime(sample.measured_at, reception);
}

// Fills the states from what `step` makes of the sample with each filter.
template <typename Step>
SensorTrack::Output SensorTrack::Answer(const sensing::MargSample& sample, Step step) {
  SampleVerdict beside_verdict = output_.verdict;
  if (!output_.probe) {
    if (output_.verdict == SampleVerdict::kFused) {
      output_.verdict = step(filter_);
      beside_verdict = beside_ != nullptr ? step(beside_) : output_.verdict;
      if (incoming_ != nullptr) {
        // Its verdict is not told: until it takes over, the samples are answered by the other one.
        static_cast<void>(step(incoming_));
        TakeIncoming();
      }
      if (IsUsed(output_.verdict)) {
        marg_.sequence.Used(sample.sequence, sample.measured_at);
      }
    }
    marg_.verdicts.Add(output_.verdict);
  }
  Fill(states_[0], *filter_);
  Count(states_[0], marg_, output_.verdict);
  if (beside_ != nullptr) {
    Fill(states_[1], *beside_);
    Count(states_[1], marg_, beside_verdict);
  }
  return output_;
}

SensorTrack::Output SensorTrack::Update(const sensing::FusedOrientation& orientation,
                                        const Reception& reception) {
  const std::size_t slot = marg_seen_ ? 1 : 0;
  ProvideSlots(slot + 1);
  SegmentState& state = states_[slot];
  Output output{.states = {&state, std::size_t{marg_seen_ && has_beside() ? 0U : 1U}}};
  Start(state, orientation.sequence, orientation.measured_at, orientation.published_at, reception);
  const auto arrival =
      Arrive(onboard_, orientation.sequence, orientation.measured_at, reception, output.lost);
  if (arrival.duplicate) {
    output.verdict = SampleVerdict::kRejectedDuplicate;
  } else if (!IsUsable(orientation)) {
    output.verdict = SampleVerdict::kRejectedNotFinite;
  } else {
    output.verdict = CheckTime(orientation.measured_at, reception);
    if (output.verdict == SampleVerdict::kFused) {
      output.verdict = CheckOrder(orientation.measured_at);
    }
  }

  state.filter = "onboard";
  state.magnetic_state = MagneticState::kUnused;
  state.at_rest = false;
  if (output.verdict == SampleVerdict::kFused) {
    onboard_.sequence.Used(orientation.sequence, orientation.measured_at);
    const Eigen::Vector3d gyro_rad_s = orientation.gyro_rad_s.cast<double>();
    const Eigen::Vector3d accel_m_s2 = orientation.accel_m_s2.cast<double>();
    const bool has_gyro =
        (orientation.flags & sensing::MargFlag::kGyroMissing) == 0 && gyro_rad_s.allFinite();
    const bool has_accel =
        (orientation.flags & sensing::MargFlag::kAccelMissing) == 0 && accel_m_s2.allFinite();
    state.started = true;
    state.degraded = false;
    state.heading = orientation.heading;
    state.q_earth_sensor = math::Canonical(orientation.q_earth_sensor.normalized());
    state.w_earth_sensor_in_sensor_rad_s.setZero();
    if (has_gyro) {
      state.w_earth_sensor_in_sensor_rad_s = orientation.gyro_rad_s;
    }
    state.free_accel_in_earth_m_s2.setZero();
    if (has_accel) {
      const Eigen::Vector3d gravity_m_s2 = units::kStandardGravity_m_s2 * Eigen::Vector3d::UnitZ();
      state.free_accel_in_earth_m_s2 =
          (state.q_earth_sensor * accel_m_s2 - gravity_m_s2).cast<float>();
    }
    const bool has_sigma = std::isfinite(orientation.sigma_rad) && orientation.sigma_rad > 0.0F;
    const float var_rad2 = has_sigma ? orientation.sigma_rad * orientation.sigma_rad : 0.0F;
    state.cov_orientation_rad2 = var_rad2 * Eigen::Matrix3f::Identity();
  }
  onboard_.verdicts.Add(output.verdict);
  Count(state, onboard_, output.verdict);
  return output;
}

}  // namespace limbcast::fusion
