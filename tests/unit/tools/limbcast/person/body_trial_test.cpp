// Acceptance of issue 4, 3 and 4: recordings of real people.
#include "tools/limbcast/person/body_trial.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/filters/filter_factory.hpp"
#include "common/math/rotation.hpp"
#include "services/fusion/sensor_track.hpp"
#include "services/gateway/drivers/replay/recording_reader.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/services/posture/posture_rig.hpp"
#include "tools/limbcast/person/body_figures.hpp"

namespace limbcast::tool {
namespace {

const BodyPhases kFullBody{.standing = TimeSpan{0.0, 4.0},
                           .sitting = TimeSpan{13.0, 38.5},
                           .walks = {{56.0, 75.0}, {77.0, 98.0}}};
/// Walks four metres, turns, and so on.
const BodyPhases kLowerBody{.standing = TimeSpan{0.3, 4.0}, .sitting = {}, .walks = {{9.0, 23.5}}};

void ExpectAllHold(const std::vector<BodyFigure>& figures, std::size_t at_least) {
  EXPECT_GE(figures.size(), at_least);
  for (const BodyFigure& figure : figures) {
    EXPECT_TRUE(figure.holds()) << figure.name << " is " << figure.value << ", not in ["
                                << figure.low << ", " << figure.high << "]";
  }
}

TEST(BodyTrialTest, AWholePersonWithoutMagnetometersIsCalibratedByItselfAndBelievable) {
  LIMBCAST_SKIP_WITHOUT_SHARED("data/fullbody");
  const auto recording =
      gateway::ReadRecording(*test_support::SharedPath("data/fullbody") / "walking_fullbody.hdf5");
  ASSERT_TRUE(recording.ok()) << recording.error().message;
  BodyTrialOptions options;
  options.posture.automatic_calibration = true;
  const auto trace = RunCalibratedTrial(*recording, options);
  ASSERT_TRUE(trace.ok()) << trace.error().message;
  ASSERT_TRUE(trace->calibrated);
  ExpectAllHold(BodyFigures(*trace, kFullBody), 60);
}

/// A recording through the fusion service's tracks and over the bus through a posture service.
void Replay(const gateway::Recording& recording, posture::PostureRig& rig) {
  roster::RosterEntry entry;
  entry.body_id = BodyId{1};
  entry.person = "Anna";
  std::map<SensorUid, std::unique_ptr<fusion::SensorTrack>> tracks;
  const fusion::FilterFactory factory = [](std::string_view name) {
    return filters::MakeFilter(name, {});
  };
  for (const gateway::RecordedSensor& sensor : recording.sensors) {
    entry.sensors.push_back({sensor.info.sensor_uid, *sensor.segment});
    tracks[sensor.info.sensor_uid] = std::make_unique<fusion::SensorTrack>(
        entry.body_id,
        fusion::TrackPlan{.sensor_uid = sensor.info.sensor_uid,
                          .segment = *sensor.segment,
                          .filters = {.name = "bmf", .beside = ""}},
        factory, std::chrono::hours(1));
  }
  rig.Roster(entry);
  std::size_t next = 0;
  for (const gateway::RecordedTick& tick : recording.ticks) {
    rig.Advance(std::chrono::milliseconds(10));
    for (; next < tick.marg_end; ++next) {
      sensing::MargSample sample = recording.marg[next];
      sample.measured_at = rig.clock.Now();
      const auto output = tracks[sample.sensor_uid]->Update(
          sample, {.received_at = sample.measured_at, .overloads = 0});
      for (const body::SegmentState& state : output.states) {
        rig.Send(state);
      }
    }
  }
}

TEST(BodyTrialTest, TheSameHoldsForTheSkeletonTopicAndAProfileFromTheDisk) {
  LIMBCAST_SKIP_WITHOUT_SHARED("data/fullbody");
  const auto recording =
      gateway::ReadRecording(*test_support::SharedPath("data/fullbody") / "walking_fullbody.hdf5");
  ASSERT_TRUE(recording.ok()) << recording.error().message;
  posture::PostureConfig config;
  config.automatic_calibration = true;
  const test_support::TemporaryFolder folder;
  config.state_dir = folder.path().string();
  {
    posture::PostureRig rig(config);
    Replay(*recording, rig);
    EXPECT_EQ(rig.Counted(posture::Count::kCalibrations), 1U);
  }
  posture::PostureRig rig(config);  // the service was restarted, and the filters with it
  const Time start = rig.clock.Now();
  Replay(*recording, rig);
  BodyTrace trace;
  for (const body::Skeleton& skeleton : rig.skeletons) {
    BodyFrame frame;
    frame.time_s = ToSeconds(skeleton.measured_at - start);
    for (const body::SegmentPose& pose : skeleton.segments) {
      const std::size_t i = body::Index(pose.segment);
      frame.known[i] = pose.status == body::SegmentStatus::kTracked;
      frame.q_earth_segment[i] = pose.q_earth_segment.cast<double>();
    }
    trace.frames.push_back(frame);
  }
  BodyPhases phases = kFullBody;
  phases.standing->from_s = 0.6;  // the filters take half a second to start
  ExpectAllHold(BodyFigures(trace, phases), 60);
}

gateway::Recording LowerBody() {
  gateway::RecordingOptions options;
  options.assignments = {{"00B42268", "t8"},
                         {"00B42279", "pelvis"},
                         {"00B4227C", "right_upper_leg"},
                         {"00B4227D", "right_lower_leg"},
                         {"00B421EE", "left_upper_leg"},
                         {"00B421ED", "left_lower_leg"},
                         {"00B421EF", "right_foot"},
                         {"00B421E6", "left_foot"}};
  auto recording =
      gateway::ReadRecording(*test_support::SharedPath("data/xsens_lowerbody"), options);
  EXPECT_TRUE(recording.ok());
  return std::move(*recording);
}

Result<BodyTrace> FromTheFirstSample(const gateway::Recording& recording) {
  BodyTrialOptions options;
  options.reference_pose_s = 0.2;  // as soon as there is half a window to average
  options.walk_until_s = 23.5;
  return RunCalibratedTrial(recording, options);
}

TEST(BodyTrialTest, SensorsWithOrientationOnBoardAreCalibratedFromTheFirstSample) {
  LIMBCAST_SKIP_WITHOUT_SHARED("data/xsens_lowerbody");
  const auto trace = FromTheFirstSample(LowerBody());
  ASSERT_TRUE(trace.ok()) << trace.error().message;
  ASSERT_TRUE(trace->calibrated) << trace->events.back();
  std::vector<BodyFigure> figures = BodyFigures(*trace, kLowerBody);
  // That knees stay in the sagittal plane is asked of walking straight on; a third of this is
  // turns.
  std::erase_if(figures, [](const BodyFigure& figure) {
    return figure.name.find("out of the sagittal plane") != std::string::npos;
  });
  ExpectAllHold(figures, 20);
}

TEST(BodyTrialTest, TurningTheWholeRecordingAboutTheVerticalTurnsThePersonAndNothingElse) {
  LIMBCAST_SKIP_WITHOUT_SHARED("data/xsens_lowerbody");
  const gateway::Recording recording = LowerBody();
  const auto straight = FromTheFirstSample(recording);
  ASSERT_TRUE(straight.ok());
  for (const double turn_rad : {0.5, 1.7, 3.0, -2.2}) {
    gateway::Recording turned = recording;
    const Eigen::Quaterniond turn = math::ExpSO3({0.0, 0.0, turn_rad});
    for (sensing::FusedOrientation& sample : turned.orientation) {
      sample.q_earth_sensor = turn * sample.q_earth_sensor;
    }
    const auto trace = FromTheFirstSample(turned);
    ASSERT_TRUE(trace.ok());
    ASSERT_EQ(trace->frames.size(), straight->frames.size());
    double worst_rad = 0.0;
    for (std::size_t i = 0; i < trace->frames.size(); ++i) {
      const BodyFrame& one = straight->frames[i];
      const BodyFrame& other = trace->frames[i];
      for (const body::Segment segment : body::AllSegments()) {
        const std::size_t s = body::Index(segment);
        if (one.known[s] && other.known[s]) {
          // The posture: every segment about the pelvis.
          worst_rad = std::max(
              worst_rad, math::AngleBetween_rad(
                             one.q_earth_segment[0].conjugate() * one.q_earth_segment[s],
                             other.q_earth_segment[0].conjugate() * other.q_earth_segment[s]));
        }
      }
    }
    EXPECT_LT(worst_rad, 0.01745) << "1 deg, turned by " << turn_rad;
  }
}

}  // namespace
}  // namespace limbcast::tool
