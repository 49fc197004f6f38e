// Cost of the posture stage for one body and frame; the goal is ≤ 20 µs with 23 segments.
#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

#include "common/body/default_body.hpp"
#include "common/body/joint_angle_frame.hpp"
#include "common/bus/inproc/inproc_bus.hpp"
#include "common/math/rotation.hpp"
#include "services/posture/body_tracker.hpp"
#include "services/posture/posture_service.hpp"
#include "tests/support/fake_clock.hpp"
#include "tests/support/immediate_pool.hpp"

namespace limbcast::posture {
namespace {

constexpr BodyId kBody{1};
constexpr Duration kPeriod = std::chrono::milliseconds(10);

std::vector<body::Segment> Sensors(std::int64_t count) {
  if (count == static_cast<std::int64_t>(body::kSegmentCount)) {
    return {body::AllSegments().begin(), body::AllSegments().end()};
  }
  return {body::ReducedSegments().begin(), body::ReducedSegments().end()};
}

roster::RosterEntry Roster(const std::vector<body::Segment>& sensors) {
  roster::RosterEntry entry;
  entry.body_id = kBody;
  for (const body::Segment segment : sensors) {
    entry.sensors.push_back({SensorUid{body::Index(segment) + 1}, segment});
  }
  return entry;
}

/// The default person, every sensor aligned, so that contacts are looked for.
body::BodyDefinition Aligned() {
  body::BodyDefinition body = *body::MakeDefaultBody(kBody);
  for (body::SegmentDefinition& segment : body.segments) {
    segment.aligned = true;
    segment.sensor_uid = SensorUid{body::Index(segment.segment) + 1};
  }
  return body;
}

/// One second of a person whose every segment turns about its own axis.
std::vector<body::SegmentState> Movement(const std::vector<body::Segment>& sensors, Time start) {
  std::vector<body::SegmentState> states;
  for (int tick = 0; tick < 100; ++tick) {
    for (const body::Segment segment : sensors) {
      body::SegmentState state;
      state.body_id = kBody;
      state.segment = segment;
      state.sensor_uid = SensorUid{body::Index(segment) + 1};
      state.verdict = SampleVerdict::kFused;
      state.started = true;
      state.measured_at = start + tick * kPeriod;
      const Eigen::Vector3d axis(0.3, 1.0, 0.1 * static_cast<double>(body::Index(segment)));
      state.q_earth_sensor = math::ExpSO3(0.02 * tick * axis);
      state.w_earth_sensor_in_sensor_rad_s = (2.0 * axis).cast<float>();
      states.push_back(state);
    }
  }
  return states;
}

void BM_BodyTrackerFrame(benchmark::State& state) {
  PostureConfig config;
  config.joint_limits = state.range(1) != 0;
  config.contacts = state.range(2) != 0;
  const bool angles = state.range(2) != 0;
  body::JointAngleFrame frame;
  std::size_t emitted = 0;
  std::uint32_t contacts = 0;
  BodyTracker tracker(config, Aligned(), [&](body::Skeleton& skeleton, TickEnd, bool) {
    benchmark::DoNotOptimize(skeleton.segments.data());
    contacts |= skeleton.contacts;
    if (angles) {
      body::FillJointAngles(skeleton, frame);
      benchmark::DoNotOptimize(frame.joints.data());
    }
    ++emitted;
  });
  const auto sensors = Sensors(state.range(0));
  tracker.SetRoster(Roster(sensors));
  const Time start = TimeFromNanoseconds(1'700'000'000'000'000'000);
  const auto movement = Movement(sensors, start);
  Duration shift{};
  std::size_t next = 0;
  for (auto _ : state) {
    for (std::size_t i = 0; i < sensors.size(); ++i) {
      StateInput input = MakeStateInput(movement[next + i], start);
      input.measured_at += shift;
      benchmark::DoNotOptimize(tracker.OnState(input, start));
    }
    next += sensors.size();
    if (next == movement.size()) {
      next = 0;
      shift += 100 * kPeriod;
    }
  }
  if (emitted != static_cast<std::size_t>(state.iterations())) {
    state.SkipWithError("not one skeleton for each tick");
  }
  if ((contacts != 0) != config.contacts) {
    state.SkipWithError("contacts are not as they were asked for");
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_BodyTrackerFrame)
    ->ArgNames({"sensors", "limits", "contacts_angles"})
    ->Args({23, 0, 0})
    ->Args({23, 0, 1})
    ->Args({23, 1, 1})
    ->Args({15, 0, 0})
    ->Args({15, 1, 1})
    ->Unit(benchmark::kMicrosecond);

/// States written to skeleton read, in one thread and process: bus, queue, worker and tracker.
void BM_InprocEndToEndFrame(benchmark::State& state) {
  test_support::FakeClock clock;
  test_support::ImmediatePool pool;
  const auto hub = bus::inproc::MakeHub(&clock);
  const auto bus = bus::inproc::MakeBus(hub);
  std::size_t emitted = 0;
  const auto skeletons = *bus->MakeReader<body::Skeleton>(
      {.on_sample = [&](const body::Skeleton&, const bus::SampleInfo&) { ++emitted; },
       .on_disposed = {}});
  const auto states = *bus->MakeWriter<body::SegmentState>();
  const auto rosters = *bus->MakeWriter<roster::RosterEntry>();
  PostureService service({}, clock, *bus, pool);
  const auto sensors = Sensors(state.range(0));
  if (!service.Start() || !rosters->Write(Roster(sensors))) {
    state.SkipWithError("no service");
    return;
  }
  auto movement = Movement(sensors, clock.Now());
  std::size_t next = 0;
  for (auto _ : state) {
    for (std::size_t i = 0; i < sensors.size(); ++i) {
      body::SegmentState& sample = movement[next + i];
      benchmark::DoNotOptimize(states->Write(sample));
      sample.measured_at += 100 * kPeriod;  // for the next round
    }
    clock.Advance(kPeriod);
    next = (next + sensors.size()) % movement.size();
  }
  if (emitted != static_cast<std::size_t>(state.iterations())) {
    state.SkipWithError("not one skeleton for each tick");
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_InprocEndToEndFrame)
    ->ArgName("sensors")
    ->Arg(23)
    ->Arg(15)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace limbcast::posture
