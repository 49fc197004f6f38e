#include "services/posture/posture_service.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <mutex>
#include <thread>

#include "common/math/rotation.hpp"
#include "common/runtime/system_clock.hpp"
#include "common/runtime/thread_pool.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/services/posture/posture_rig.hpp"

namespace limbcast::posture {
namespace {

using body::Segment;
using ::testing::HasSubstr;
using namespace std::chrono_literals;

constexpr BodyId kBody{1};
const std::vector<Segment> kThree = {Segment::kPelvis, Segment::kT8, Segment::kHead};

TEST(PostureServiceTest, StatesOfUnknownBodiesSegmentsAndSensorsAreCounted) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, kThree));
  rig.Tick(BodyId{9}, {Segment::kPelvis});
  rig.Tick(kBody, {Segment::kLeftHand});
  body::SegmentState other_sensor = MakeState(kBody, Segment::kHead, rig.clock.Now());
  other_sensor.sensor_uid = SensorUid{5};
  rig.Send(other_sensor);
  rig.Advance(1s);
  EXPECT_EQ(rig.Counted(Count::kStatesUnassigned), 3U);
  EXPECT_TRUE(rig.skeletons.empty());
}

TEST(PostureServiceTest, TheFilterThatRunsBesideIsNotHeard) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, {Segment::kPelvis}));
  body::SegmentState beside = MakeState(kBody, Segment::kPelvis, rig.clock.Now());
  beside.slot = 1;
  rig.Send(beside);
  EXPECT_TRUE(rig.skeletons.empty());
  EXPECT_EQ(rig.Counted(Count::kStatesReceived), 0U);
}

TEST(PostureServiceTest, JointAnglesComeWithEverySkeletonOfAMovingPerson) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, {Segment::kRightUpperLeg, Segment::kRightLowerLeg}));
  rig.Send(MakeState(kBody, Segment::kRightUpperLeg, rig.clock.Now()));
  rig.Send(
      MakeState(kBody, Segment::kRightLowerLeg, rig.clock.Now(), math::ExpSO3({0.0, 1.0, 0.0})));
  ASSERT_EQ(rig.skeletons.size(), 1U);
  ASSERT_EQ(rig.angles.size(), 1U);
  EXPECT_EQ(rig.angles[0].body_id, kBody);
  EXPECT_EQ(rig.angles[0].sequence, rig.skeletons[0].sequence);
  EXPECT_EQ(rig.angles[0].measured_at, rig.skeletons[0].measured_at);
  ASSERT_EQ(rig.angles[0].joints.size(), body::kJointCount);
  EXPECT_NEAR(rig.angles[0].joints[body::Index(body::Joint::kRightKnee)].angle_rad.x(), 1.0, 1e-5);
}

TEST(PostureServiceTest, JointAnglesCanBeSwitchedOff) {
  PostureConfig config;
  config.joint_angles = false;
  PostureRig rig(config);
  rig.Roster(MakeRoster(kBody, kThree));
  rig.Tick(kBody, kThree);
  EXPECT_EQ(rig.skeletons.size(), 1U);
  EXPECT_TRUE(rig.angles.empty());
}

TEST(PostureServiceTest, TwoBodiesDoNotDisturbEachOther) {
  PostureRig rig({}, 2);
  const BodyId other{2};
  rig.Roster(MakeRoster(kBody, kThree));
  rig.Roster(MakeRoster(other, {Segment::kPelvis, Segment::kHead}));
  rig.Tick(kBody, {Segment::kPelvis, Segment::kT8});  // incomplete
  rig.Tick(other, {Segment::kPelvis, Segment::kHead});
  ASSERT_EQ(rig.skeletons.size(), 1U);
  EXPECT_EQ(rig.skeletons[0].body_id, other);
  rig.Advance(8ms);
  ASSERT_EQ(rig.skeletons.size(), 2U);
  EXPECT_EQ(rig.skeletons[1].body_id, kBody);
}

TEST(PostureServiceTest, TheSkeletonsDoNotDependOnTheNumberOfWorkers) {
  const auto run = [](std::size_t workers) {
    PostureRig rig({}, workers);
    for (std::uint32_t id = 1; id <= 5; ++id) {
      rig.Roster(MakeRoster(BodyId{id}, kThree));
    }
    for (int tick = 0; tick < 20; ++tick) {
      rig.Advance(10ms);
      for (std::uint32_t id = 1; id <= 5; ++id) {
        rig.Tick(BodyId{id}, kThree, math::ExpSO3({0.01 * tick, 0.1 * id, 0.0}));
      }
    }
    return rig.skeletons;
  };
  const auto one = run(1);
  const auto four = run(4);
  ASSERT_EQ(one.size(), 100U);
  ASSERT_EQ(four.size(), 100U);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].body_id, four[i].body_id);
    for (std::size_t s = 0; s < one[i].segments.size(); ++s) {
      EXPECT_TRUE(one[i].segments[s].q_earth_segment.coeffs() ==
                  four[i].segments[s].q_earth_segment.coeffs());
      EXPECT_TRUE(one[i].segments[s].p_earth_segment_m == four[i].segments[s].p_earth_segment_m);
    }
  }
}

TEST(PostureServiceTest, StageTimesAreThoseOfTheStateThatCompletedTheTick) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, {Segment::kPelvis, Segment::kT8}));
  rig.Send(MakeState(kBody, Segment::kPelvis, rig.clock.Now()));
  rig.Advance(5ms);
  body::SegmentState last = MakeState(kBody, Segment::kT8, rig.clock.Now());
  last.stages.fusion_published_at = rig.clock.Now() + 123us;
  rig.Send(last);
  ASSERT_EQ(rig.skeletons.size(), 1U);
  const body::StageTimes& stages = rig.skeletons[0].stages;
  EXPECT_EQ(stages.gateway_published_at, last.stages.gateway_published_at);
  EXPECT_EQ(stages.fusion_published_at, last.stages.fusion_published_at);
  EXPECT_EQ(stages.posture_received_at, rig.clock.Now());
  EXPECT_EQ(stages.posture_published_at, rig.clock.Now());
}

TEST(PostureServiceTest, AFrameOfStatesIsAsGoodAsItsStatesAlone) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, kThree));
  body::SegmentFrame frame;
  frame.body_id = kBody;
  for (const Segment segment : kThree) {
    frame.states.push_back(MakeState(kBody, segment, rig.clock.Now()));
  }
  frame.states.push_back(frame.states.front());
  frame.states.back().slot = 1;  // the filter beside: nobody poses by it
  ASSERT_TRUE(rig.frames->Write(frame).ok());
  ASSERT_EQ(rig.skeletons.size(), 1U);
  EXPECT_TRUE(rig.skeletons[0].complete);
  EXPECT_EQ(rig.Counted(Count::kStatesReceived), kThree.size());
  EXPECT_EQ(rig.Counted(Count::kStatesUsed), kThree.size());
}

TEST(PostureServiceTest, TheRootIsWhereThePositionFixSays) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, kThree));
  rig.Tick(kBody, kThree);
  EXPECT_NEAR(rig.Last(Segment::kPelvis).p_earth_segment_m.z(), 0.530 * 1.75, 1e-6)
      << "without a fix the person stands on the floor";
  sensing::PositionFix fix;
  fix.body_id = kBody;
  fix.p_earth_body_m = {3.0, 4.0, 1.1};
  ASSERT_TRUE(rig.fixes->Write(fix).ok());
  rig.Advance(10ms);
  rig.Tick(kBody, kThree);
  EXPECT_LT(
      (rig.Last(Segment::kPelvis).p_earth_segment_m - Eigen::Vector3f(3.0F, 4.0F, 1.1F)).norm(),
      1e-5F);
}

TEST(PostureServiceTest, TheDefinitionIsPublishedWithEveryChangeAndItsRevisionGrows) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, kThree));
  ASSERT_EQ(rig.definitions.size(), 1U);
  EXPECT_EQ(rig.definitions[0].name, "walker");
  EXPECT_TRUE(rig.definitions[0].segments[0].tracked);
  EXPECT_EQ(rig.definitions[0].segments[0].sensor_uid, UidOf(kBody, Segment::kPelvis));
  EXPECT_FALSE(rig.definitions[0].segments[1].tracked);
  rig.Roster(MakeRoster(kBody, kThree));
  EXPECT_EQ(rig.definitions.size(), 1U) << "no change, no message";
  rig.Tick(kBody, kThree);  // says that heading is magnetic
  ASSERT_EQ(rig.definitions.size(), 2U);
  EXPECT_EQ(rig.definitions[1].heading, HeadingReference::kMagnetic);
  EXPECT_GT(rig.definitions[1].revision, rig.definitions[0].revision);
  EXPECT_EQ(rig.skeletons.back().definition_revision, rig.definitions[1].revision);
}

TEST(PostureServiceTest, ARepeatedCommandIsAnsweredAgainAndDoneOnce) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, kThree));
  rig.Run(kBody, kThree, 0.5);
  roster::Command command;
  command.client_uid = 5;
  command.request_id = 6;
  command.body_id = kBody;
  command.kind = roster::CommandKind::kReferencePose;
  ASSERT_TRUE(rig.commands->Write(command).ok());
  const std::size_t definitions = rig.definitions.size();
  ASSERT_TRUE(rig.commands->Write(command).ok());
  ASSERT_EQ(rig.replies.size(), 2U);
  EXPECT_TRUE(rig.replies[0].accepted);
  EXPECT_EQ(rig.replies[1].request_id, 6U);
  EXPECT_EQ(rig.replies[1].message, rig.replies[0].message);
  EXPECT_EQ(rig.definitions.size(), definitions);
  EXPECT_EQ(rig.Counted(Count::kCommandsAccepted), 1U);
}

TEST(PostureServiceTest, APersonWhoLeavesTheRosterIsDisposedAndKeepsTheAlignmentForTheReturn) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, kThree));
  rig.Run(kBody, kThree, 0.5, math::ExpSO3({0.3, 0.0, 0.0}));
  ASSERT_TRUE(rig.Command(kBody, roster::CommandKind::kReferencePose).accepted);
  ASSERT_TRUE(rig.rosters->Dispose(MakeRoster(kBody, {})).ok());
  EXPECT_EQ(rig.gone, std::vector<BodyId>{kBody});
  const std::size_t before = rig.skeletons.size();
  rig.Run(kBody, kThree, 0.1);
  EXPECT_EQ(rig.skeletons.size(), before);
  EXPECT_FALSE(rig.Command(kBody, roster::CommandKind::kReferencePose).accepted);

  rig.Roster(MakeRoster(kBody, kThree));
  EXPECT_TRUE(rig.definitions.back().segments[0].aligned);
  rig.Run(kBody, kThree, 0.1, math::ExpSO3({0.3, 0.0, 0.0}));
  EXPECT_LT(math::AngleBetween_rad(rig.Last(Segment::kT8).q_earth_segment.cast<double>(),
                                   Eigen::Quaterniond::Identity()),
            1e-6);
}

TEST(PostureServiceTest, TheAlignmentSurvivesARestartOfTheFilters) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, kThree));
  const Eigen::Quaterniond mounted = math::ExpSO3({0.3, 0.1, -0.4});
  rig.Run(kBody, kThree, 0.5, mounted);
  ASSERT_TRUE(rig.Command(kBody, roster::CommandKind::kReferencePose).accepted);
  for (const Segment segment : kThree) {  // the filters begin again, with nothing yet
    rig.Advance(10ms);
    body::SegmentState fresh = MakeState(kBody, segment, rig.clock.Now());
    fresh.started = false;
    fresh.verdict = SampleVerdict::kStarting;
    rig.Send(fresh);
  }
  rig.Run(kBody, kThree, 0.1, mounted);
  EXPECT_TRUE(rig.definitions.back().segments[0].aligned);
  EXPECT_LT(math::AngleBetween_rad(rig.Last(Segment::kHead).q_earth_segment.cast<double>(),
                                   Eigen::Quaterniond::Identity()),
            1e-6);
}

TEST(PostureServiceTest, AlignmentAndDimensionsSurviveARestartOfTheService) {
  const test_support::TemporaryFolder folder;
  PostureConfig config;
  config.state_dir = folder.path().string();
  const Eigen::Quaterniond mounted = math::ExpSO3({0.3, 0.1, -0.4});
  std::uint32_t revision = 0;
  {
    PostureRig rig(config);
    rig.Roster(MakeRoster(kBody, kThree));
    rig.Run(kBody, kThree, 0.5, mounted);
    ASSERT_TRUE(rig.Command(kBody, roster::CommandKind::kReferencePose).accepted);
    ASSERT_TRUE(rig.Command(kBody, roster::CommandKind::kSetDimensions, "height", {1.9}).accepted);
    revision = rig.definitions.back().revision;
  }
  PostureRig rig(config);
  rig.Roster(MakeRoster(kBody, kThree));
  EXPECT_TRUE(rig.definitions.back().segments[0].aligned);
  EXPECT_GE(rig.definitions.back().revision, revision);
  rig.Run(kBody, kThree, 0.1, mounted);
  EXPECT_LT(math::AngleBetween_rad(rig.Last(Segment::kHead).q_earth_segment.cast<double>(),
                                   Eigen::Quaterniond::Identity()),
            1e-6);
  EXPECT_NEAR(rig.Last(Segment::kPelvis).p_earth_segment_m.z(), 0.530 * 1.9, 1e-6);
}

TEST(PostureServiceTest, AProfileIsSavedRestoredByNameAndFollowsThePerson) {
  const test_support::TemporaryFolder folder;
  PostureConfig config;
  config.state_dir = folder.path().string();
  const Eigen::Quaterniond mounted = math::ExpSO3({0.3, 0.1, -0.4});
  const auto aligned = [](const PostureRig& rig) {
    return rig.definitions.back().segments[0].aligned;
  };
  {
    PostureRig rig(config);
    rig.Roster(MakeRoster(kBody, kThree));
    rig.Run(kBody, kThree, 0.5, mounted);
    ASSERT_TRUE(rig.Command(kBody, roster::CommandKind::kReferencePose).accepted);
    EXPECT_TRUE(rig.Command(kBody, roster::CommandKind::kProfile, "save left handed").accepted);
    ASSERT_TRUE(rig.Command(kBody, roster::CommandKind::kUndo).accepted);
    EXPECT_FALSE(aligned(rig));
    const auto loaded = rig.Command(kBody, roster::CommandKind::kProfile, "load left handed");
    EXPECT_EQ(loaded.message, "profile left handed in force, 3 segments aligned");
    EXPECT_TRUE(aligned(rig));
    EXPECT_EQ(rig.Command(kBody, roster::CommandKind::kProfile, "load nobody").message,
              "no profile \"nobody\"");
    EXPECT_FALSE(rig.Command(kBody, roster::CommandKind::kProfile, "burn it").accepted);
    EXPECT_TRUE(aligned(rig)) << "a refusal changes nothing";
  }
  // The same person as another body, over another gateway: uids are of serial numbers.
  PostureRig rig(config);
  roster::RosterEntry elsewhere = MakeRoster(kBody, kThree);
  elsewhere.body_id = BodyId{77};
  rig.Roster(elsewhere);
  EXPECT_TRUE(aligned(rig));
  EXPECT_EQ(rig.definitions.back().body_id, BodyId{77});
}

TEST(PostureServiceTest, ABadStateFolderIsRefusedAtStart) {
  PostureConfig config;
  config.state_dir = "/proc/no/such/folder";
  PostureRig rig(config);
  ASSERT_FALSE(rig.started.ok());
  EXPECT_THAT(rig.started.error().message, HasSubstr("posture.state_dir"));
}

TEST(PostureServiceTest, HealthCountsAndMeasures) {
  PostureRig rig;
  rig.Roster(MakeRoster(kBody, kThree));
  rig.Run(kBody, kThree, 0.1);
  ServiceHealth health;
  rig.service->FillHealth(health);
  const auto value = [&](std::string_view name) {
    for (const NamedValue& v : health.values) {
      if (v.name == name) {
        return v.value;
      }
    }
    return -1.0;
  };
  EXPECT_EQ(value("states.received"), 30.0);
  EXPECT_EQ(value("skeletons"), 10.0);
  EXPECT_EQ(value("skeletons.complete"), 10.0);
  EXPECT_EQ(value("gauge.bodies"), 1.0);
  EXPECT_EQ(value("gauge.state_writers"), 2.0);  // alone, and as frames
  ASSERT_FALSE(health.latencies.empty());
  EXPECT_EQ(health.latencies[0].stage, "sensor_to_posture");
  EXPECT_EQ(health.latencies[0].count, 10U);
  EXPECT_TRUE(health.last_error.empty());
}

TEST(PostureServiceTest, WithThreadsAndSeveralWritersEveryTickOfEveryBodyIsEmittedOnce) {
  // Real threads, so that sanitizers see the hand-over; the deadline is far, so that a slow machine
  // does not end a tick early.
  constexpr std::uint32_t kBodies = 6;
  constexpr int kTicks = 200;
  const runtime::SystemClock clock;
  const auto hub = bus::inproc::MakeHub(&clock);
  const auto bus = bus::inproc::MakeBus(hub);
  runtime::ThreadPool pool("posture", 3);
  PostureConfig config;
  config.tick_deadline_s = 1.0;
  PostureService service(config, clock, *bus, pool);
  std::mutex mutex;
  std::map<BodyId, std::vector<Time>> emitted;
  const auto reader = *bus->MakeReader<body::Skeleton>(
      {.on_sample =
           [&](const body::Skeleton& skeleton, const bus::SampleInfo&) {
             const std::scoped_lock lock(mutex);
             emitted[skeleton.body_id].push_back(skeleton.measured_at);
           },
       .on_disposed = {}});
  ASSERT_TRUE(service.Start().ok());
  // Topics are not ordered among each other: who is who is known before the first state.
  const auto rosters = *bus->MakeWriter<roster::RosterEntry>();
  for (std::uint32_t id = 1; id <= kBodies; ++id) {
    ASSERT_TRUE(rosters->Write(MakeRoster(BodyId{id}, kThree)).ok());
  }
  const Time start = clock.Now();
  std::vector<std::thread> writers;
  for (std::uint32_t id = 1; id <= kBodies; ++id) {
    writers.emplace_back([&, id] {
      const auto states = *bus->MakeWriter<body::SegmentState>();
      for (int tick = 1; tick <= kTicks; ++tick) {
        for (const Segment segment : kThree) {
          EXPECT_TRUE(states->Write(MakeState(BodyId{id}, segment, start + tick * 10ms)).ok());
        }
      }
    });
  }
  for (std::thread& writer : writers) {
    writer.join();
  }
  service.Stop();  // finishes what is queued
  const std::scoped_lock lock(mutex);
  ASSERT_EQ(emitted.size(), kBodies);
  for (const auto& [body_id, times] : emitted) {
    ASSERT_EQ(times.size(), static_cast<std::size_t>(kTicks)) << body_id.value;
    for (int tick = 1; tick <= kTicks; ++tick) {
      EXPECT_EQ(times[static_cast<std::size_t>(tick - 1)], start + tick * 10ms);
    }
  }
}

}  // namespace
}  // namespace limbcast::posture
