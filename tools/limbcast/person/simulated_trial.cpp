#include "tools/limbcast/person/simulated_trial.hpp"

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "common/body/default_body.hpp"
#include "common/math/rotation.hpp"
#include "common/simulation/magnetic_world.hpp"
#include "common/simulation/person_motion.hpp"
#include "common/simulation/random.hpp"
#include "common/simulation/sensor_set.hpp"

namespace limbcast::tool {
namespace {

constexpr double kPi = std::numbers::pi;

struct WornSensor {
  body::Segment segment;
  SensorUid uid;
  simulation::SensorMounting mounting;
  simulation::MargModel model;
};

std::vector<WornSensor> Wear(const SimulatedPersonOptions& person,
                             const simulation::PersonShape& shape) {
  std::vector<WornSensor> sensors;
  for (const body::Segment segment : body::SixteenSegments()) {
    const std::string name(body::ToString(segment));
    sensors.push_back(
        {segment, SensorUid{body::Index(segment) + 1},
         simulation::MakeMounting(segment, shape, simulation::MountingStyle::kArbitrary,
                                  person.seed),
         simulation::MargModel(simulation::MakeMargErrors(person.noise), person.rate_hz,
                               simulation::Random(person.seed, name))});
  }
  return sensors;
}

/// Sums of squares of one window.
struct Sums {
  double segment = 0.0;
  double joint = 0.0;
  double segments = 0.0;
  double joints = 0.0;
  double frames = 0.0;
  body::PerSegment<double> relative{};
};

TruthErrors ErrorsOf(const Sums& sums, double from_s, double to_s) {
  TruthErrors errors{.from_s = from_s, .to_s = to_s};
  double relative = 0.0;
  for (std::size_t i = 0; i < body::kSegmentCount; ++i) {
    relative += sums.relative[i];
    errors.worst_rms_rad[i] = sums.frames > 0.0 ? std::sqrt(sums.relative[i] / sums.frames) : 0.0;
  }
  if (sums.segments > 0.0 && sums.joints > 0.0) {
    errors.segment_rms_rad = std::sqrt(sums.segment / sums.segments);
    errors.relative_rms_rad = std::sqrt(relative / sums.segments);
    errors.joint_rms_rad = std::sqrt(sums.joint / sums.joints);
  }
  return errors;
}

using Orientations = body::PerSegment<Eigen::Quaterniond>;

void Compare(const Orientations& q, const Orientations& truth, Sums& sums) {
  const auto angle_rad = [](const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
    return math::AngleBetween_rad(a, b);
  };
  const std::size_t pelvis = body::Index(body::Segment::kPelvis);
  const Eigen::Quaterniond back =
      math::ExpSO3({0.0, 0.0, -math::Heading_rad(q[pelvis] * truth[pelvis].conjugate())});
  sums.frames += 1.0;
  for (const body::Segment segment : body::SixteenSegments()) {
    const std::size_t i = body::Index(segment);
    sums.segment += std::pow(angle_rad(q[i], truth[i]), 2);
    sums.relative[i] += std::pow(angle_rad(back * q[i], truth[i]), 2);
    sums.segments += 1.0;
    if (const auto parent = body::ParentOf(segment)) {
      const std::size_t p = body::Index(*parent);
      sums.joint +=
          std::pow(angle_rad(q[p].conjugate() * q[i], truth[p].conjugate() * truth[i]), 2);
      sums.joints += 1.0;
    }
  }
}

}  // namespace

simulation::MotionSchedule MakeCalibrationSchedule() {
  using simulation::Phase;
  using simulation::PhaseKind;
  // Round a track: 12 m, half a turn, and back.
  const std::vector<simulation::PathPiece> track{{.length_m = 12.0, .turn_rad = 0.0},
                                                 {.length_m = 4.0, .turn_rad = kPi},
                                                 {.length_m = 12.0, .turn_rad = 0.0},
                                                 {.length_m = 4.0, .turn_rad = kPi}};
  Phase walk;
  walk.kind = PhaseKind::kWalk;
  walk.path = track;
  Phase n_pose;
  n_pose.kind = PhaseKind::kNPose;
  n_pose.duration_s = 5.0;
  Phase sit;
  sit.kind = PhaseKind::kSit;
  sit.duration_s = 20.0;
  Phase left;
  left.kind = PhaseKind::kTurn;
  left.duration_s = 5.0;
  left.turn_rad = kPi;
  Phase right = left;
  right.turn_rad = -kPi;
  Phase stand;
  stand.duration_s = 8.0;
  stand.gestures = {{.kind = simulation::GestureKind::kRaiseFront, .start_s = 1.0}};
  return {.phases = {n_pose, walk, sit, left, stand, right, walk}, .repeat_from = 2};
}

Result<SimulatedTrace> RunSimulatedTrial(const SimulatedPersonOptions& person,
                                         const BodyTrialOptions& options, double compare_from_s,
                                         double window_s) {
  const auto shape = simulation::MakePersonShape(options.posture.body_height_m);
  if (!shape) {
    return shape.error();
  }
  const auto motion = simulation::PersonMotion::Make(
      *shape, {.schedule = person.schedule, .start = {.heading_rad = person.facing_rad}});
  if (!motion) {
    return motion.error();
  }
  std::vector<WornSensor> sensors = Wear(person, *shape);
  std::vector<roster::SensorAssignment> assignments;
  assignments.reserve(sensors.size());
  for (const WornSensor& sensor : sensors) {
    assignments.push_back({sensor.uid, sensor.segment});
  }
  Orientations q{};
  auto bench = BodyBench::Make(options, assignments, [&](const body::Skeleton& skeleton) {
    for (const body::SegmentPose& pose : skeleton.segments) {
      q[body::Index(pose.segment)] = pose.q_earth_segment.cast<double>();
    }
  });
  if (!bench) {
    return bench.error();
  }
  const simulation::MagneticWorld world;
  SimulatedTrace trace;
  Sums sums;
  double from_s = compare_from_s;
  const auto ticks = static_cast<std::int64_t>(person.duration_s * person.rate_hz);
  for (std::int64_t tick = 0; tick < ticks; ++tick) {
    const double time_s = static_cast<double>(tick) / person.rate_hz;
    const Time at = Time{} + std::chrono::hours(1) + DurationFromSeconds(time_s);
    const simulation::PersonPose pose = motion->At(time_s);
    Orientations truth{};
    for (std::size_t i = 0; i < body::kSegmentCount; ++i) {
      truth[i] = math::QuaternionFromMatrix(pose.segments[i].R_earth_local);
    }
    for (WornSensor& sensor : sensors) {
      sensing::MargSample sample;
      sample.sensor_uid = sensor.uid;
      sample.measured_at = at;
      sensor.model.Read(simulation::MakeIdealMarg(pose.segments[body::Index(sensor.segment)],
                                                  sensor.mounting, world),
                        sample);
      if (!person.magnetometer) {
        sample.mag_tesla.setZero();
        sample.flags = (sample.flags & ~std::uint32_t{sensing::kMagSaturated}) |
                       std::uint32_t{sensing::kMagMissing};
      }
      (*bench)->Feed(sample);
    }
    (*bench)->EndTick(at, time_s);
    if (time_s < compare_from_s) {
      continue;
    }
    Compare(q, truth, sums);
    if (time_s + 1.0 / person.rate_hz >= from_s + window_s) {
      trace.windows.push_back(ErrorsOf(std::exchange(sums, Sums{}), from_s, from_s + window_s));
      from_s += window_s;
    }
  }
  trace.events = (*bench)->events();
  trace.calibrated = (*bench)->calibrated();
  return trace;
}

}  // namespace limbcast::tool
