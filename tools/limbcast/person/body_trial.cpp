#include "tools/limbcast/person/body_trial.hpp"

#include <utility>

namespace limbcast::tool {
namespace {

// Streams begin well after time zero, which means "no time".
constexpr Duration kOffset = std::chrono::hours(1);

BodyFrame FrameOf(const body::Skeleton& skeleton, const BodyBench& bench, double time_s) {
  BodyFrame frame;
  frame.time_s = time_s;
  for (std::size_t row = 0; row < skeleton.segments.size(); ++row) {
    const body::SegmentPose& pose = skeleton.segments[row];
    const std::size_t i = body::Index(pose.segment);
    frame.known[i] = pose.status == body::SegmentStatus::kTracked && bench.aligned(row);
    frame.q_earth_segment[i] = pose.q_earth_segment.cast<double>();
  }
  return frame;
}

}  // namespace

double JointAngle_rad(const BodyFrame& frame, body::Joint joint, int which) {
  const body::JointSegments segments = body::SegmentsOf(joint);
  return body::AnglesOf(joint, frame.q_earth_segment[body::Index(*segments.parent)],
                        frame.q_earth_segment[body::Index(segments.child)])
      .angle_rad[which];
}

bool Knows(const BodyFrame& frame, body::Joint joint) {
  const body::JointSegments segments = body::SegmentsOf(joint);
  return frame.known[body::Index(*segments.parent)] && frame.known[body::Index(segments.child)];
}

Result<BodyTrace> RunBodyTrial(const gateway::Recording& recording,
                               const BodyTrialOptions& options) {
  std::vector<roster::SensorAssignment> sensors;
  for (const gateway::RecordedSensor& sensor : recording.sensors) {
    if (sensor.segment) {
      sensors.push_back({sensor.info.sensor_uid, *sensor.segment});
    }
  }
  BodyTrace trace;
  double time_s = 0.0;
  const BodyBench* running = nullptr;
  auto bench = BodyBench::Make(options, sensors, [&](const body::Skeleton& skeleton) {
    trace.frames.push_back(FrameOf(skeleton, *running, time_s));
  });
  if (!bench) {
    return bench.error();
  }
  running = bench->get();
  std::size_t marg = 0;
  std::size_t orientation = 0;
  for (const gateway::RecordedTick& tick : recording.ticks) {
    time_s = ToSeconds(tick.at - recording.ticks.front().at);
    for (; marg < tick.marg_end; ++marg) {
      sensing::MargSample sample = recording.marg[marg];
      sample.measured_at += kOffset;
      (*bench)->Feed(sample);
    }
    for (; orientation < tick.orientation_end; ++orientation) {
      sensing::FusedOrientation sample = recording.orientation[orientation];
      sample.measured_at += kOffset;
      (*bench)->Feed(sample);
    }
    (*bench)->EndTick(tick.at + kOffset, time_s);
  }
  trace.definition = (*bench)->Definition();
  trace.events = (*bench)->events();
  trace.calibrated = (*bench)->calibrated();
  return trace;
}

Result<BodyTrace> RunCalibratedTrial(const gateway::Recording& recording,
                                     BodyTrialOptions options) {
  auto first = RunBodyTrial(recording, options);
  if (!first || !first->calibrated) {
    return first;
  }
  options.restored = first->definition;
  options.reference_pose_s.reset();
  options.walk_until_s.reset();
  options.posture.automatic_calibration = true;
  auto second = RunBodyTrial(recording, options);
  if (second) {
    second->events.insert(second->events.begin(), first->events.begin(), first->events.end());
    second->calibrated = true;
  }
  return second;
}

}  // namespace limbcast::tool
