#include "tools/limbcast/monitor/orientation_errors.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "common/math/rotation.hpp"

namespace limbcast::tool {
namespace {

constexpr std::size_t kMaxTruths = 1024;   // about 4 s at 286 Hz, 10 s at 100 Hz
constexpr std::size_t kMaxWaiting = 1024;  // a truth that has not come by then never will
// Further apart than this, the truth had a gap (hidden markers): nothing is judged in it.
constexpr Duration kMaxTruthGap = std::chrono::milliseconds(50);

bool Earlier(const body::SegmentTruth& truth, Time time) { return truth.measured_at < time; }

}  // namespace

void OrientationErrors::AddTruth(const body::SegmentTruth& truth) {
  Track& track = tracks_[{truth.body_id, truth.segment}];
  if (!track.truths.empty() && truth.measured_at <= track.truths.back().measured_at) {
    return;  // the simulator's truth is in order; a loop of a recording moves its times on
  }
  track.truths.push_back(truth);
  if (track.truths.size() > kMaxTruths) {
    track.truths.pop_front();
  }
  Judge(track, track.segments, Level::kSegment);
  Judge(track, track.sensors, Level::kSensor);
}

void OrientationErrors::AddSkeleton(const body::Skeleton& skeleton) {
  for (const body::SegmentPose& pose : skeleton.segments) {
    if (pose.status != body::SegmentStatus::kTracked) {
      continue;
    }
    Track& track = tracks_[{skeleton.body_id, pose.segment}];
    track.segments.push_back({skeleton.measured_at, pose.q_earth_segment.cast<double>()});
    Judge(track, track.segments, Level::kSegment);
  }
}

void OrientationErrors::AddSegmentState(const body::SegmentState& state) {
  if (!state.started || state.slot != 0 || !IsUsed(state.verdict)) {
    return;
  }
  Track& track = tracks_[{state.body_id, state.segment}];
  track.sensors.push_back({state.measured_at, state.q_earth_sensor});
  Judge(track, track.sensors, Level::kSensor);
}

void OrientationErrors::Judge(Track& track, std::deque<Judged>& waiting, Level level) {
  while (waiting.size() > kMaxWaiting) {
    waiting.pop_front();
  }
  while (!waiting.empty() && !track.truths.empty() &&
         waiting.front().measured_at <= track.truths.back().measured_at) {
    const Judged judged = waiting.front();
    waiting.pop_front();
    const auto after =
        std::lower_bound(track.truths.begin(), track.truths.end(), judged.measured_at, Earlier);
    const bool exact = after->measured_at == judged.measured_at;
    if (!count_from_ || judged.measured_at < *count_from_ ||
        (after == track.truths.begin() && !exact)) {
      continue;
    }
    const auto before = exact ? after : std::prev(after);
    const bool segment = level == Level::kSegment;
    const bool valid = segment
                           ? before->segment_valid && after->segment_valid
                           : before->sensor_valid && after->sensor_valid && !before->segment_valid;
    const Duration gap = after->measured_at - before->measured_at;
    if (!valid || gap > kMaxTruthGap) {
      continue;
    }
    const double t =
        exact ? 0.0 : ToSeconds(judged.measured_at - before->measured_at) / ToSeconds(gap);
    const Eigen::Quaterniond truth =
        segment ? math::Slerp(before->q_earth_segment, after->q_earth_segment, t)
                : math::Slerp(before->q_earth_sensor, after->q_earth_sensor, t);
    const double error_rad = math::AngleBetween_rad(truth, judged.q_earth_any);
    track.sum_squares_rad2 += error_rad * error_rad;
    track.max_rad = std::max(track.max_rad, error_rad);
    ++track.count;
  }
}

std::optional<OrientationErrors::Summary> OrientationErrors::Get() const {
  Summary all;
  double sum_squares_rad2 = 0.0;
  for (const auto& [key, track] : tracks_) {
    all.count += track.count;
    all.max_rad = std::max(all.max_rad, track.max_rad);
    sum_squares_rad2 += track.sum_squares_rad2;
  }
  if (all.count == 0) {
    return std::nullopt;
  }
  all.rms_rad = std::sqrt(sum_squares_rad2 / static_cast<double>(all.count));
  return all;
}

std::map<OrientationErrors::Key, OrientationErrors::Summary> OrientationErrors::BySegment() const {
  std::map<Key, Summary> result;
  for (const auto& [key, track] : tracks_) {
    if (track.count > 0) {
      result[key] = {std::sqrt(track.sum_squares_rad2 / static_cast<double>(track.count)),
                     track.max_rad, track.count};
    }
  }
  return result;
}

}  // namespace limbcast::tool
