#include "services/posture/body_calibrator.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "common/body/default_body.hpp"
#include "tests/support/walking_person.hpp"

namespace limbcast::posture {
namespace {

using body::Segment;
using test_support::WalkingPerson;
using ::testing::HasSubstr;
using namespace std::chrono_literals;

class BodyCalibratorTest : public ::testing::Test {
 protected:
  BodyCalibratorTest() {
    for (const Segment segment : segments_) {
      tracked_ |= BitOf(segment);
    }
  }
  static Time At(double t_s) { return Time{1000s} + DurationFromSeconds(t_s); }

  /// The simulated stance and walk from one time to another, at 50 Hz.
  std::optional<CalibrationOutcome> Run(double from_s, double to_s, bool automatic) {
    for (double t_s = from_s; t_s < to_s; t_s += 0.02) {
      for (const Segment segment : segments_) {
        const auto reading = person_.Read(segment, t_s);
        calibrator_.Add(segment, At(t_s), reading.q_earth_sensor,
                        reading.accel_in_earth_m_s2.cast<float>());
      }
      if (automatic) {
        if (auto outcome = calibrator_.Automatic(tracked_, false)) {
          return outcome;
        }
      }
    }
    return std::nullopt;
  }

  WalkingPerson person_;
  const std::vector<Segment> segments_ = WalkingPerson::Sixteen();
  SegmentSet tracked_ = 0;
  BodyCalibrator calibrator_;
};

TEST_F(BodyCalibratorTest, FindsStanceAndWalkByItself) {
  const auto outcome = Run(0.0, 40.0, true);
  ASSERT_TRUE(outcome.has_value());
  EXPECT_EQ(outcome->fit.segments.size(), segments_.size());
  EXPECT_TRUE(outcome->left_out.empty());
  EXPECT_GE(outcome->fit.walked_s, 0.9 * BodyCalibrator::kAutomaticWalk_s);
}

TEST_F(BodyCalibratorTest, WithoutAStanceItWaits) {
  EXPECT_FALSE(Run(5.0, 33.0, true).has_value());
}

TEST_F(BodyCalibratorTest, ByCommandItTellsWhatIsMissing) {
  EXPECT_THAT(calibrator_.Start(At(0.0)).error().message, HasSubstr("reference pose"));
  (void)Run(0.0, 4.0, false);
  calibrator_.NoteStance(person_.Standing(segments_), At(4.0));
  ASSERT_TRUE(calibrator_.Start(At(4.0)).ok());
  (void)Run(4.0, 7.0, false);
  EXPECT_THAT(calibrator_.Finish(tracked_, 0.0, false).error().message, HasSubstr("go on"));
  EXPECT_TRUE(calibrator_.started()) << "too short a walk goes on";
  (void)Run(7.0, 24.0, false);
  const auto outcome = calibrator_.Finish(tracked_, 0.0, false);
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_FALSE(calibrator_.started());
}

TEST_F(BodyCalibratorTest, ASensorThatWasNotHeardIsNamedAndTheOthersAreAligned) {
  (void)Run(0.0, 4.0, false);
  calibrator_.NoteStance(person_.Standing(segments_), At(4.0));
  ASSERT_TRUE(calibrator_.Start(At(4.0)).ok());
  (void)Run(4.0, 24.0, false);
  const auto outcome = calibrator_.Finish(tracked_ | BitOf(Segment::kRightToe), 0.0, false);
  ASSERT_TRUE(outcome.ok());
  body::BodyDefinition definition = *body::MakeDefaultBody(BodyId{1});
  const std::string text = ApplyFit(*outcome, definition);
  EXPECT_THAT(text, HasSubstr("aligned 16 segments"));
  EXPECT_THAT(text, HasSubstr("right_toe: not heard all the time"));
  EXPECT_GT(definition.segments[0].alignment_quality, 0.3F) << "and the confidence knows";
  EXPECT_LT(definition.segments[0].alignment_quality, 1.0F);
  EXPECT_EQ(std::count_if(definition.segments.begin(), definition.segments.end(),
                          [](const auto& segment) { return segment.aligned; }),
            16);
}

TEST_F(BodyCalibratorTest, TheArmsHeadingsAreSeenWhileWalking) {
  (void)Run(4.0, 20.0, false);
  body::PerSegment<double> correction_rad{};
  for (const Segment segment : segments_) {
    correction_rad[body::Index(segment)] = -person_.sensor_heading_rad(segment);
  }
  correction_rad[body::Index(Segment::kLeftForeArm)] += 0.4;  // drifted
  const auto errors = calibrator_.SurveyArms(tracked_, correction_rad);
  ASSERT_EQ(errors.size(), 6U);
  for (const auto& seen : errors) {
    EXPECT_NEAR(std::remainder(seen.error_rad, 2.0 * std::numbers::pi),
                seen.segment == Segment::kLeftForeArm ? 0.4 : 0.0, 0.15)
        << body::ToString(seen.segment);
  }
}

}  // namespace
}  // namespace limbcast::posture
