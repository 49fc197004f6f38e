#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/bus/inproc/inproc_bus.hpp"
#include "services/posture/posture_service.hpp"
#include "tests/support/fake_clock.hpp"
#include "tests/support/immediate_pool.hpp"

namespace limbcast::posture {

inline SensorUid UidOf(BodyId body_id, body::Segment segment) {
  return SensorUid{1000ULL * body_id.value + body::Index(segment) + 1};
}

/// A started, clean state of one segment, measured at `at`.
inline body::SegmentState MakeState(
    BodyId body_id, body::Segment segment, Time at,
    const Eigen::Quaterniond& q_earth_sensor = Eigen::Quaterniond::Identity()) {
  body::SegmentState state;
  state.body_id = body_id;
  state.segment = segment;
  state.sensor_uid = UidOf(body_id, segment);
  state.verdict = SampleVerdict::kFused;
  state.started = true;
  state.heading = HeadingReference::kMagnetic;
  state.measured_at = at;
  state.stages.gateway_published_at = at + std::chrono::milliseconds(1);
  state.stages.fusion_received_at = at + std::chrono::milliseconds(2);
  state.stages.fusion_published_at = at + std::chrono::milliseconds(3);
  state.q_earth_sensor = q_earth_sensor;
  return state;
}

inline roster::RosterEntry MakeRoster(BodyId body_id, const std::vector<body::Segment>& segments) {
  roster::RosterEntry entry;
  entry.body_id = body_id;
  entry.revision = 1;
  entry.person = "walker";
  for (const body::Segment segment : segments) {
    entry.sensors.push_back({UidOf(body_id, segment), segment});
  }
  return entry;
}

/// A posture service with everything around it in the test's hands: in-process bus, fake clock, a
/// pool that works at once.
class PostureRig {
 public:
  explicit PostureRig(const PostureConfig& config = {}, std::size_t workers = 1)
      : pool_(workers), hub_(bus::inproc::MakeHub(&clock)), bus_(bus::inproc::MakeBus(hub_)) {
    skeleton_reader_ = *bus_->MakeReader<body::Skeleton>(
        {.on_sample = [this](const body::Skeleton& value,
                             const bus::SampleInfo&) { skeletons.push_back(value); },
         .on_disposed = [this](const body::Skeleton& key) { gone.push_back(key.body_id); }});
    angle_reader_ = *bus_->MakeReader<body::JointAngleFrame>(
        {.on_sample = [this](const body::JointAngleFrame& value,
                             const bus::SampleInfo&) { angles.push_back(value); },
         .on_disposed = {}});
    definition_reader_ = *bus_->MakeReader<body::BodyDefinition>(
        {.on_sample = [this](const body::BodyDefinition& value,
                             const bus::SampleInfo&) { definitions.push_back(value); },
         .on_disposed = {}});
    reply_reader_ = *bus_->MakeReader<roster::CommandReply>(
        {.on_sample = [this](const roster::CommandReply& value,
                             const bus::SampleInfo&) { replies.push_back(value); },
         .on_disposed = {}});
    states = *bus_->MakeWriter<body::SegmentState>();
    frames = *bus_->MakeWriter<body::SegmentFrame>();
    rosters = *bus_->MakeWriter<roster::RosterEntry>();
    commands = *bus_->MakeWriter<roster::Command>();
    fixes = *bus_->MakeWriter<sensing::PositionFix>();
    other_definitions = *bus_->MakeWriter<body::BodyDefinition>();
    service = std::make_unique<PostureService>(config, clock, *bus_, pool_);
    started = service->Start();
  }

  void Roster(const roster::RosterEntry& entry) { EXPECT_TRUE(rosters->Write(entry).ok()); }
  void Send(const body::SegmentState& state) { EXPECT_TRUE(states->Write(state).ok()); }

  /// One tick of all `segments`, measured now.
  void Tick(BodyId body_id, const std::vector<body::Segment>& segments,
            const Eigen::Quaterniond& q_earth_sensor = Eigen::Quaterniond::Identity()) {
    for (const body::Segment segment : segments) {
      Send(MakeState(body_id, segment, clock.Now(), q_earth_sensor));
    }
  }

  /// `seconds` of ticks at 100 Hz, the clock running with them.
  void Run(BodyId body_id, const std::vector<body::Segment>& segments, double seconds,
           const Eigen::Quaterniond& q_earth_sensor = Eigen::Quaterniond::Identity()) {
    for (int i = 0; i < static_cast<int>(seconds * 100.0 + 0.5); ++i) {
      Advance(std::chrono::milliseconds(10));
      Tick(body_id, segments, q_earth_sensor);
    }
  }

  /// Time passes; what is due is done.
  void Advance(Duration by) {
    clock.Advance(by);
    pool_.RunDue(clock.Now());
  }

  roster::CommandReply Command(BodyId body_id, roster::CommandKind kind, std::string text = "",
                               std::vector<double> numbers = {}) {
    roster::Command command;
    command.client_uid = 77;
    command.request_id = ++requests_;
    command.body_id = body_id;
    command.kind = kind;
    command.text = std::move(text);
    command.numbers = std::move(numbers);
    replies.clear();
    EXPECT_TRUE(commands->Write(command).ok());
    if (replies.size() != 1 || replies[0].request_id != requests_) {
      ADD_FAILURE() << replies.size() << " replies";
      return {};
    }
    return replies[0];
  }

  [[nodiscard]] std::uint64_t Counted(Count count) const { return service->counters().Read(count); }

  const body::SegmentPose& Last(body::Segment segment) const {
    for (const body::SegmentPose& pose : skeletons.back().segments) {
      if (pose.segment == segment) {
        return pose;
      }
    }
    ADD_FAILURE() << "no " << body::ToString(segment);
    return skeletons.back().segments.front();
  }

  test_support::FakeClock clock;

 private:
  test_support::ImmediatePool pool_;
  std::shared_ptr<bus::inproc::Hub> hub_;
  std::unique_ptr<bus::Bus> bus_;
  std::unique_ptr<bus::Reader<body::Skeleton>> skeleton_reader_;
  std::unique_ptr<bus::Reader<body::JointAngleFrame>> angle_reader_;
  std::unique_ptr<bus::Reader<body::BodyDefinition>> definition_reader_;
  std::unique_ptr<bus::Reader<roster::CommandReply>> reply_reader_;
  std::uint64_t requests_ = 0;

 public:
  std::vector<body::Skeleton> skeletons;
  std::vector<body::JointAngleFrame> angles;
  std::vector<body::BodyDefinition> definitions;
  std::vector<roster::CommandReply> replies;
  std::vector<BodyId> gone;
  std::unique_ptr<bus::Writer<body::SegmentState>> states;
  std::unique_ptr<bus::Writer<body::SegmentFrame>> frames;
  std::unique_ptr<bus::Writer<roster::RosterEntry>> rosters;
  std::unique_ptr<bus::Writer<roster::Command>> commands;
  std::unique_ptr<bus::Writer<sensing::PositionFix>> fixes;
  std::unique_ptr<bus::Writer<body::BodyDefinition>> other_definitions;  // of another service
  Status started;
  std::unique_ptr<PostureService> service;  // last: it goes first
};

}  // namespace limbcast::posture
