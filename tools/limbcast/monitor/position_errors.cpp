#include "tools/limbcast/monitor/position_errors.hpp"

#include <algorithm>
#include <cmath>

namespace limbcast::tool {
namespace {

constexpr std::size_t kMaxTicks = 128;  // what has not come by then, lagged ones too, never will

}  // namespace

PositionErrors::Tick& PositionErrors::TickAt(BodyId body_id, Time at) {
  std::deque<Tick>& ticks = ticks_[body_id];
  auto place = std::lower_bound(ticks.begin(), ticks.end(), at,
                                [](const Tick& tick, Time time) { return tick.at < time; });
  if (place != ticks.end() && place->at == at) {
    return *place;
  }
  place = ticks.emplace(place);
  place->at = at;
  if (ticks.size() > kMaxTicks) {
    const bool dropped = place == ticks.begin();
    if (!dropped) {
      Judge(body_id, ticks.front());
      const auto index = place - ticks.begin();
      ticks.pop_front();
      return ticks[static_cast<std::size_t>(index - 1)];
    }
  }
  return *place;
}

void PositionErrors::AddTruth(const body::SegmentTruth& truth) {
  TickAt(truth.body_id, truth.measured_at).truths[truth.segment] = truth;
}

void PositionErrors::AddSegmentState(const body::SegmentState& state) {
  if (!state.started || !IsUsed(state.verdict)) {
    return;
  }
  if (state.slot == 0) {
    TickAt(state.body_id, state.measured_at).states[state.segment] = state;
  } else if (state.slot == body::kLaggedSlot) {
    TickAt(state.body_id, state.measured_at).lagged[state.segment] = state;
  }
}

void PositionErrors::AddSkeleton(const body::Skeleton& skeleton) {
  TickAt(skeleton.body_id, skeleton.measured_at).skeleton = skeleton;
}

void PositionErrors::Add(Summary& summary, double error_m, double sigma_m) {
  const double n = static_cast<double>(summary.count);
  const auto mean = [n](double rms, double value) {
    return std::sqrt((n * rms * rms + value * value) / (n + 1.0));
  };
  summary.rms_m = mean(summary.rms_m, error_m);
  summary.sigma_m = mean(summary.sigma_m, sigma_m);
  summary.max_m = std::max(summary.max_m, error_m);
  ++summary.count;
}

void PositionErrors::JudgeState(const Tick& tick, const body::SegmentState& state,
                                std::map<Key, Summary>& into) {
  const auto truth = tick.truths.find(state.segment);
  if (!state.has_position || truth == tick.truths.end()) {
    return;
  }
  const Eigen::Vector3d p_m = state.p_earth_sensor_m.cast<double>();
  const double sigma_m = std::sqrt(static_cast<double>(state.cov_position_m2.trace()));
  if (state.position_reference == PositionReference::kEarth) {
    Add(into[{state.body_id, state.segment}], (p_m - truth->second.p_earth_sensor_m).norm(),
        sigma_m);
    return;
  }
  const auto from = tick.states.find(state.position_from);
  const auto from_truth = tick.truths.find(state.position_from);
  if (from == tick.states.end() || from_truth == tick.truths.end()) {
    return;
  }
  const Eigen::Vector3d truth_m =
      from_truth->second.q_earth_sensor.conjugate() *
      (truth->second.p_earth_sensor_m - from_truth->second.p_earth_sensor_m);
  Add(into[{state.body_id, state.segment}],
      (from->second.q_earth_sensor.conjugate() * p_m - truth_m).norm(), sigma_m);
}

void PositionErrors::Judge(BodyId body_id, const Tick& tick) {
  const auto root = tick.truths.find(body::Segment::kPelvis);
  if (!count_from_ || tick.at < *count_from_ || root == tick.truths.end() ||
      !root->second.segment_valid) {
    return;
  }
  for (const auto& [segment, state] : tick.states) {
    JudgeState(tick, state, sensors_);
  }
  for (const auto& [segment, state] : tick.lagged) {
    JudgeState(tick, state, lagged_);
  }
  if (!tick.skeleton || tick.skeleton->segments.empty() ||
      tick.skeleton->segments.front().segment != body::Segment::kPelvis) {
    return;
  }
  const Eigen::Vector3d root_m = tick.skeleton->segments.front().p_earth_segment_m.cast<double>();
  for (const body::SegmentPose& pose : tick.skeleton->segments) {
    const auto truth = tick.truths.find(pose.segment);
    if (truth == tick.truths.end()) {
      continue;
    }
    Eigen::Vector3d off_m = pose.p_earth_segment_m.cast<double>() - truth->second.p_earth_segment_m;
    if (pose.segment != body::Segment::kPelvis) {
      off_m -= root_m - root->second.p_earth_segment_m;
    }
    Add(joints_[{body_id, pose.segment}], off_m.norm(), 0.0);
  }
}

}  // namespace limbcast::tool
