// A real person, eight sensors on trunk and legs with orientation on board and without a gyro's
// readings (../shared/data): does the person walk over the ground, with one foot always on it?
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "common/body/joint_angles.hpp"
#include "common/math/rotation.hpp"
#include "services/gateway/drivers/replay/recording_reader.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/unit/services/posture/posture_rig.hpp"

namespace limbcast {
namespace {

using namespace std::chrono_literals;
using body::Index;
using body::Segment;
using Eigen::Vector3d;

constexpr BodyId kBody{1};
constexpr double kDeg = std::numbers::pi / 180.0;

// As the README of the data says.
const std::map<std::string, Segment> kWorn = {{"00B42268", Segment::kT8},
                                              {"00B42279", Segment::kPelvis},
                                              {"00B4227C", Segment::kRightUpperLeg},
                                              {"00B4227D", Segment::kRightLowerLeg},
                                              {"00B421EE", Segment::kLeftUpperLeg},
                                              {"00B421ED", Segment::kLeftLowerLeg},
                                              {"00B421EF", Segment::kRightFoot},
                                              {"00B421E6", Segment::kLeftFoot}};

struct Frame {
  double t_s = 0.0;
  Vector3d p_earth_root_m = Vector3d::Zero();
  std::uint32_t contacts = 0;
  std::array<double, body::kJointCount> first_deg{};
};

std::vector<Frame> Walk(const gateway::Recording& recording, double facing_rad) {
  posture::PostureRig rig;
  roster::RosterEntry roster;
  roster.body_id = kBody;
  std::map<std::uint64_t, Segment> segments;
  for (const gateway::RecordedSensor& sensor : recording.sensors) {
    const std::string& serial = sensor.info.serial;
    const auto worn =
        kWorn.find(serial.substr(serial.size() - std::min<std::size_t>(8, serial.size())));
    if (worn != kWorn.end()) {
      roster.sensors.push_back({sensor.info.sensor_uid, worn->second});
      segments[sensor.info.sensor_uid.value] = worn->second;
    } else {
      ADD_FAILURE() << serial;
    }
  }
  rig.Roster(roster);
  std::vector<Frame> frames;
  const Time start = rig.clock.Now();
  std::size_t next = 0;
  // The first sample is the calibration pose: it is held until the window of the reference is full.
  for (int i = -50; next < recording.ticks.size(); ++i) {
    rig.Advance(10ms);
    const std::size_t begin = i <= 0 ? 0 : recording.ticks[next - 1].orientation_end;
    for (std::size_t s = begin; s < recording.ticks[next].orientation_end; ++s) {
      const sensing::FusedOrientation& sample = recording.orientation[s];
      const auto found = segments.find(sample.sensor_uid.value);
      if (found == segments.end()) {
        continue;
      }
      body::SegmentState state = posture::MakeState(kBody, found->second, rig.clock.Now(),
                                                    sample.q_earth_sensor.normalized());
      state.sensor_uid = sample.sensor_uid;
      state.free_accel_in_earth_m_s2 =
          (state.q_earth_sensor * sample.accel_m_s2.cast<double>() - Vector3d(0.0, 0.0, 9.81))
              .cast<float>();
      rig.Send(state);
    }
    if (i == -1) {
      const auto reply =
          rig.Command(kBody, roster::CommandKind::kReferencePose, "n_pose", {facing_rad});
      EXPECT_TRUE(reply.accepted) << reply.message;
    } else if (i >= 0 && !rig.skeletons.empty() && !rig.angles.empty()) {
      Frame frame;
      frame.t_s = ToSeconds(rig.clock.Now() - start);
      frame.p_earth_root_m = rig.Last(Segment::kPelvis).p_earth_segment_m.cast<double>();
      frame.contacts = rig.skeletons.back().contacts;
      for (const body::JointAngle& joint : rig.angles.back().joints) {
        frame.first_deg[Index(joint.joint)] = static_cast<double>(joint.angle_rad.x()) / kDeg;
      }
      frames.push_back(frame);
    }
    rig.skeletons.clear();
    rig.angles.clear();
    next += i >= 0 ? 1 : 0;
  }
  return frames;
}

struct Figures {
  double standing_m = 0.0;
  double right = 0.0;  // parts of the time after the first steps
  double left = 0.0;
  double both = 0.0;
  double none = 0.0;
  double lowest_m = 9.0;
  double highest_m = 0.0;
  double fastest_m_s = 0.0;
  std::array<double, 2> knee_deg{};
  double west_apart_m = 0.0;
  double east_apart_m = 0.0;
};

Figures FiguresOf(const std::vector<Frame>& frames) {
  constexpr std::size_t kStands = 450;  // frames
  constexpr std::size_t kWalks = 650;
  constexpr std::size_t kBack = 1600;  // halfway: the second round begins about here
  Figures figures;
  std::array<double, 2> west_m{9.0, 9.0};
  std::array<double, 2> east_m{-9.0, -9.0};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Frame& frame = frames[i];
    if (i < kStands) {
      figures.standing_m =
          std::max(figures.standing_m, (frame.p_earth_root_m - frames[0].p_earth_root_m).norm());
    }
    if (i < kWalks) {
      continue;
    }
    const bool right = (frame.contacts & (1U << Index(Segment::kRightFoot))) != 0;
    const bool left = (frame.contacts & (1U << Index(Segment::kLeftFoot))) != 0;
    const double one = 1.0 / static_cast<double>(frames.size() - kWalks);
    figures.right += right ? one : 0.0;
    figures.left += left ? one : 0.0;
    figures.both += right && left ? one : 0.0;
    figures.none += right || left ? 0.0 : one;
    figures.lowest_m = std::min(figures.lowest_m, frame.p_earth_root_m.z());
    figures.highest_m = std::max(figures.highest_m, frame.p_earth_root_m.z());
    figures.fastest_m_s = std::max(figures.fastest_m_s,
                                   (frame.p_earth_root_m - frames[i - 100].p_earth_root_m).norm());
    for (std::size_t side = 0; side < 2; ++side) {
      const std::size_t knee = Index(side == 0 ? body::Joint::kRightKnee : body::Joint::kLeftKnee);
      figures.knee_deg[side] = std::max(figures.knee_deg[side], frame.first_deg[knee]);
    }
    const std::size_t round = i < kBack ? 0 : 1;
    west_m[round] = std::min(west_m[round], frame.p_earth_root_m.x());
    east_m[round] = std::max(east_m[round], frame.p_earth_root_m.x());
  }
  figures.west_apart_m = std::abs(west_m[0] - west_m[1]);
  figures.east_apart_m = std::abs(east_m[0] - east_m[1]);
  return figures;
}

TEST(RealWalkerTest, APersonWithLowerBodySensorsWalksOverTheGround) {
  LIMBCAST_SKIP_WITHOUT_SHARED("data/xsens_lowerbody");
  const auto recording = gateway::ReadRecording(*test_support::SharedPath("data/xsens_lowerbody"));
  ASSERT_TRUE(recording.ok()) << recording.error().message;
  // The way that the legs walk in the earth frame hardly depends on which way the person is thought
  // to face. So the first pass, which takes it for east, says how far that is from where it walks.
  const auto first = Walk(*recording, 0.0);
  ASSERT_GT(first.size(), 1350U);
  const Vector3d ahead_m = first[1350].p_earth_root_m - first[1150].p_earth_root_m;
  const double facing_rad = std::atan2(ahead_m.y(), ahead_m.x()) -
                            kDeg * first[1250].first_deg[Index(body::Joint::kPelvis)];
  const auto frames = Walk(*recording, facing_rad);
  ASSERT_GT(frames.size(), 500U);
  ASSERT_GT(frames.size(), 2400U);
  const Figures figures = FiguresOf(frames);
  std::cout << std::fixed << std::setprecision(3) << "standing moves the root by "
            << figures.standing_m << " m; walking: right foot down " << figures.right
            << " of the time, left " << figures.left << ", both " << figures.both << ", none "
            << figures.none << "; root " << figures.lowest_m << " to " << figures.highest_m
            << " m high, " << figures.fastest_m_s << " m/s at most; knees bend to "
            << figures.knee_deg[0] << " and " << figures.knee_deg[1]
            << " deg; there and back, ends " << figures.west_apart_m << " m and "
            << figures.east_apart_m << " m apart\n";

  EXPECT_LT(figures.standing_m, 0.03);
  // A foot is down for about 60 % of a stride, both are for about 20 % (Perry, "Gait Analysis",
  // chapter 1); here the person also turns, at which both are longer.
  for (const double down : {figures.right, figures.left}) {
    EXPECT_GT(down, 0.55);
    EXPECT_LT(down, 0.70);
  }
  EXPECT_GT(figures.both, 0.15);
  EXPECT_LT(figures.both, 0.35);
  EXPECT_LT(figures.none, 0.01);
  // The pelvis rises and falls by some 4 cm and never higher than the straight legs are long.
  EXPECT_GT(figures.lowest_m, 0.86);
  EXPECT_LT(figures.highest_m, 0.94);
  EXPECT_GT(figures.fastest_m_s, 0.7);
  EXPECT_LT(figures.fastest_m_s, 1.5);
  for (const double knee_deg : figures.knee_deg) {
    EXPECT_GT(knee_deg, 50.0);
    EXPECT_LT(knee_deg, 80.0);
  }
  // The person walks to and fro on one line and turns at the same ends each time.
  EXPECT_LT(figures.west_apart_m, 0.3);
  EXPECT_LT(figures.east_apart_m, 0.3);
}

}  // namespace
}  // namespace limbcast
