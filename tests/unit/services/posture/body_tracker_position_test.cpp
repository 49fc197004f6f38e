// Positions of fusion in the skeleton: body_tracker_position.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "common/body/default_body.hpp"
#include "common/body/sensor_place.hpp"
#include "common/math/rotation.hpp"
#include "services/posture/body_tracker.hpp"
#include "tests/unit/services/posture/posture_rig.hpp"

namespace limbcast::posture {
namespace {

using body::Segment;
using namespace std::chrono_literals;

constexpr BodyId kBody{1};
constexpr Time kStart = TimeFromNanoseconds(1'700'000'000'000'000'000);

// Pelvis, trunk and a right arm; every sensor as its segment, aligned.
class BodyTrackerPositionTest : public ::testing::Test {
 protected:
  explicit BodyTrackerPositionTest(const PostureConfig& config = {})
      : config_(config),
        tracker_(config_, Definition(), [this](const body::Skeleton& skeleton, TickEnd, bool) {
          skeletons_.push_back(skeleton);
        }) {
    tracker_.SetRoster(MakeRoster(kBody, kSegments));
  }

  static body::BodyDefinition Definition() {
    body::BodyDefinition body = *body::MakeDefaultBody(kBody);
    for (const Segment segment : kSegments) {
      body::SegmentDefinition& definition = *body::Find(body, segment);
      definition.tracked = true;
      definition.aligned = true;
      definition.sensor_uid = UidOf(kBody, segment);
    }
    return body;
  }

  // One tick; the upper arm is measured `error_rad` wrong, the wrist's position is the true one.
  // `turn_rad` is the heading of everything.
  void Tick(double error_rad, double sigma_m, double turn_rad = 0.0) {
    at_ += 10ms;
    const Eigen::Quaterniond turn = math::ExpSO3({0.0, 0.0, turn_rad});
    const Eigen::Quaterniond arm = math::ExpSO3({0.3, -0.8, 0.0});
    for (const Segment segment : kSegments) {
      const bool is_arm = body::IsArm(segment);
      Eigen::Quaterniond q = turn * (is_arm ? arm : Eigen::Quaterniond::Identity());
      if (segment == Segment::kRightUpperArm) {
        q = math::ExpSO3({0.0, error_rad, 0.0}) * q;
      }
      body::SegmentState state = MakeState(kBody, segment, at_, q);
      if (segment == Segment::kRightForeArm) {
        const body::BodyDefinition& body = tracker_.definition();
        body::BodyPose pose;
        pose.q_earth_segment.fill(turn);
        for (const Segment in_arm :
             {Segment::kRightUpperArm, Segment::kRightForeArm, Segment::kRightHand}) {
          pose.q_earth_segment[body::Index(in_arm)] = turn * arm;
        }
        body::ForwardKinematics(body).Place(Eigen::Vector3d::Zero(), pose);
        truth_m_ = pose.p_earth_segment_m[body::Index(Segment::kRightHand)];
        const Eigen::Vector3d p_m = pose.p_earth_segment_m[body::Index(segment)] +
                                    turn * arm * body::UsualSensorPlace_m(body, segment) -
                                    turn * body::UsualSensorPlace_m(body, Segment::kPelvis);
        state.has_position = sigma_m > 0.0;
        state.position_reference = PositionReference::kSensor;
        state.position_from = Segment::kPelvis;
        state.p_earth_sensor_m = p_m.cast<float>();
        state.cov_position_m2 = static_cast<float>(sigma_m * sigma_m) * Eigen::Matrix3f::Identity();
      }
      if (segment == Segment::kPelvis && p_earth_pelvis_sensor_m_) {
        state.has_position = true;
        state.p_earth_sensor_m = p_earth_pelvis_sensor_m_->cast<float>();
        state.cov_position_m2 = 1e-6F * Eigen::Matrix3f::Identity();
      }
      tracker_.OnState(MakeStateInput(state, at_), at_);
    }
  }

  [[nodiscard]] Eigen::Vector3d Place(Segment segment) const {
    for (const body::SegmentPose& pose : skeletons_.back().segments) {
      if (pose.segment == segment) {
        return pose.p_earth_segment_m.cast<double>();
      }
    }
    return Eigen::Vector3d::Zero();
  }
  [[nodiscard]] double WristError_m() const {
    return (Place(Segment::kRightHand) - Place(Segment::kPelvis) - truth_m_).norm();
  }

  static inline const std::vector<Segment> kSegments = {
      Segment::kPelvis, Segment::kT8, Segment::kRightUpperArm, Segment::kRightForeArm};
  PostureConfig config_;
  std::vector<body::Skeleton> skeletons_;
  BodyTracker tracker_;
  Time at_ = kStart;
  Eigen::Vector3d truth_m_ = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> p_earth_pelvis_sensor_m_;
};

TEST_F(BodyTrackerPositionTest, ACertainPositionOfTheWristBendsTheArmBack) {
  Tick(0.1, 0.0);
  const double without_m = WristError_m();
  Tick(0.1, 0.003);
  EXPECT_GT(without_m, 0.02);
  EXPECT_LT(WristError_m(), 0.6 * without_m);
  Tick(0.1, 1.0);
  EXPECT_NEAR(WristError_m(), without_m, 0.05 * without_m) << "an uncertain one does not";
}

TEST_F(BodyTrackerPositionTest, TheHandWithoutASensorGoesAlong) {
  Tick(0.1, 0.003);
  const auto& segments = skeletons_.back().segments;
  const auto find = [&](Segment segment) {
    return *std::find_if(segments.begin(), segments.end(),
                         [&](const body::SegmentPose& pose) { return pose.segment == segment; });
  };
  EXPECT_LT(math::AngleBetween_rad(find(Segment::kRightHand).q_earth_segment.cast<double>(),
                                   find(Segment::kRightForeArm).q_earth_segment.cast<double>()),
            1e-3);
}

TEST_F(BodyTrackerPositionTest, AHeadingResetTurnsThePositionsToo) {
  // What sensors call heading 0.7 is shown as heading 0.
  body::BodyDefinition definition = tracker_.definition();
  for (body::SegmentDefinition& segment : definition.segments) {
    segment.heading_correction_rad = -0.7;
  }
  Tick(0.0, 0.0, 0.7);
  tracker_.Redefine(definition, at_);
  for (int i = 0; i < 100; ++i) {
    Tick(0.1, 0.0, 0.7);
  }
  const Eigen::Vector3d turned_m = math::ExpSO3({0.0, 0.0, -0.7}) * truth_m_;
  const auto error_m = [&] {
    return (Place(Segment::kRightHand) - Place(Segment::kPelvis) - turned_m).norm();
  };
  const double without_m = error_m();
  Tick(0.1, 0.003, 0.7);
  EXPECT_LT(error_m(), 0.6 * without_m);
}

TEST_F(BodyTrackerPositionTest, AMarkerOnThePelvisPlacesTheRoot) {
  const Eigen::Vector3d root_m(3.0, -2.0, 1.1);
  p_earth_pelvis_sensor_m_ =
      root_m + body::UsualSensorPlace_m(tracker_.definition(), Segment::kPelvis);
  for (int i = 0; i < 100; ++i) {
    Tick(0.0, 0.0);
  }
  EXPECT_LT((Place(Segment::kPelvis) - root_m).norm(), 0.005);
}

class PositionsOffTest : public BodyTrackerPositionTest {
 protected:
  static PostureConfig Off() {
    PostureConfig config;
    config.positions = false;
    return config;
  }
  PositionsOffTest() : BodyTrackerPositionTest(Off()) {}
};

TEST_F(PositionsOffTest, SwitchedOffTheyTakeNoPart) {
  Tick(0.1, 0.0);
  const double without_m = WristError_m();
  Tick(0.1, 0.003);
  EXPECT_DOUBLE_EQ(WristError_m(), without_m);
}

class ToldPlaceTest : public BodyTrackerPositionTest {
 protected:
  static PostureConfig Told() {
    PostureConfig config;
    config.sensor_places_m[Segment::kPelvis] = {0.1, 0.0, 0.0};
    return config;
  }
  ToldPlaceTest() : BodyTrackerPositionTest(Told()) {}
};

TEST_F(ToldPlaceTest, APlaceThatIsToldCounts) {
  p_earth_pelvis_sensor_m_ = Eigen::Vector3d(1.1, 0.0, 1.0);
  for (int i = 0; i < 100; ++i) {
    Tick(0.0, 0.0);
  }
  EXPECT_LT((Place(Segment::kPelvis) - Eigen::Vector3d(1.0, 0.0, 1.0)).norm(), 0.005);
}

}  // namespace
}  // namespace limbcast::posture
