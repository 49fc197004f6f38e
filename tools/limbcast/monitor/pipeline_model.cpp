#include "tools/limbcast/monitor/pipeline_model.hpp"

#include <algorithm>
#include <cmath>

#include "common/base/verdict.hpp"

namespace limbcast::tool {

void PipelineModel::On(const body::Skeleton& value, Time received_at) {
  BodyView& body = bodies[value.body_id];
  if (body.skeletons == 0) {
    if (!body::AnyTracked(value)) {
      ++probe_skeletons;
      return;
    }
    body.first_received_at = received_at;
    body.first_measured_at = value.measured_at;
  } else {
    body.longest_step = std::max(body.longest_step, value.measured_at - body.last.measured_at);
    if (value.sequence > body.last.sequence + 1) {
      body.lost += value.sequence - body.last.sequence - 1;
    }
  }
  ++body.skeletons;
  body.incomplete += value.complete ? 0 : 1;
  body.last_received_at = received_at;
  for (const body::SegmentPose& pose : value.segments) {
    if (pose.status == body::SegmentStatus::kTracked) {
      body.tracked.insert(pose.segment);
    }
  }
  latencies.Add(value, received_at);
  errors.AddSkeleton(value);
  if (judge_positions) {
    positions.AddSkeleton(value);
  }
  body.last = value;
}

void PipelineModel::On(const body::SegmentTruth& value) {
  errors.AddTruth(value);
  if (judge_positions) {
    positions.AddTruth(value);
  }
}

void PipelineModel::On(const body::SegmentState& value, Time received_at) {
  if (judge_positions) {
    positions.AddSegmentState(value);
  }
  if (value.slot != 0) {
    return;
  }
  SegmentView& segment = bodies[value.body_id].segments[value.segment];
  segment.last = value;
  ++segment.states;
  segment.last_received_at = received_at;
  errors.AddSegmentState(value);
}

void PipelineModel::Mark() {
  health.Mark();
  latencies.Restart();
  marked_skeletons = skeletons();
}

std::uint64_t PipelineModel::skeletons() const {
  std::uint64_t sum = 0;
  for (const auto& [id, body] : bodies) {
    sum += body.skeletons;
  }
  return sum;
}

std::uint64_t PipelineModel::tracked_segments() const {
  std::uint64_t sum = 0;
  for (const auto& [id, body] : bodies) {
    sum += body.tracked.size();
  }
  return sum;
}

double PipelineModel::skeleton_rate_hz() const {
  double sum_hz = 0.0;
  int counted = 0;
  for (const auto& [id, body] : bodies) {
    const double span_s = ToSeconds(body.last_received_at - body.first_received_at);
    if (body.skeletons > 1 && span_s > 0.0) {
      sum_hz += static_cast<double>(body.skeletons - 1) / span_s;
      ++counted;
    }
  }
  return counted == 0 ? 0.0 : sum_hz / counted;
}

Accounting Account(const HealthLedger& health) {
  const auto whole = [](double value) { return static_cast<std::uint64_t>(std::max(value, 0.0)); };
  Accounting result;
  result.published = whole(health.Sum("gateway", "samples.published"));
  result.lost_seen = whole(health.Sum("fusion", "samples.lost"));
  const auto verdicts = health.SumByName("fusion", "verdict.");
  std::uint64_t refused = 0;
  for (std::size_t i = 0; i < kSampleVerdictCount; ++i) {
    const auto verdict = static_cast<SampleVerdict>(i);
    const auto found = verdicts.find(std::string(ToString(verdict)));
    const std::uint64_t count = found == verdicts.end() ? 0 : whole(found->second);
    if (IsUsed(verdict)) {
      result.filtered += count;
    } else if (count > 0) {
      result.refused[std::string(ToString(verdict))] = count;
      refused += count;
    }
  }
  // A gateway that was killed did not tell of its last second; fusion did.
  result.published = std::max(result.published, result.filtered + refused);
  result.lost = result.published - result.filtered - refused;
  return result;
}

}  // namespace limbcast::tool
