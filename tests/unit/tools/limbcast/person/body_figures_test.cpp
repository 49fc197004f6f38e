#include "tools/limbcast/person/body_figures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/math/rotation.hpp"

namespace limbcast::tool {
namespace {

using body::Segment;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kPi = std::numbers::pi;

/// 20 s at 50 Hz in which the shanks bend to `peak_deg` once a second, the left half a second
/// later.
BodyTrace Walker(double peak_deg, double facing_rad) {
  BodyTrace trace;
  for (int i = 0; i < 1000; ++i) {
    BodyFrame frame;
    frame.time_s = i / 50.0;
    frame.known.fill(true);
    frame.q_earth_segment.fill(math::ExpSO3({0.0, 0.0, facing_rad}));
    const double phase = 2.0 * kPi * frame.time_s;
    const auto bend = [&](double p) {
      return math::ExpSO3({0.0, peak_deg * kPi / 180.0 * 0.5 * (1.0 - std::cos(p)), 0.0});
    };
    auto& q = frame.q_earth_segment;
    q[body::Index(Segment::kRightLowerLeg)] = q[0] * bend(phase);
    q[body::Index(Segment::kLeftLowerLeg)] = q[0] * bend(phase + kPi);
    trace.frames.push_back(frame);
  }
  return trace;
}

double Value(const std::vector<BodyFigure>& figures, const std::string& name) {
  for (const BodyFigure& figure : figures) {
    if (figure.name == name) {
      return figure.value;
    }
  }
  ADD_FAILURE() << "no figure " << name;
  return 0.0;
}

TEST(BodyFiguresTest, KneesOfAWalkAreMeasuredStrideByStride) {
  const auto figures =
      BodyFigures(Walker(65.0, 0.7), {.standing = {}, .sitting = {}, .walks = {{2.0, 12.0}}});
  EXPECT_NEAR(Value(figures, "walk 1: right knee, strides"), 10.0, 1.0);
  EXPECT_NEAR(Value(figures, "walk 1: right knee, least peak of flexion"), 65.0, 0.5);
  EXPECT_NEAR(Value(figures, "walk 1: left knee, straightest moment of the worst stride"), 0.0,
              0.5);
  EXPECT_NEAR(Value(figures, "walk 1: knees, right mean less left mean"), 0.0, 0.5);
  EXPECT_NEAR(Value(figures, "walk 1: left knee, out of the sagittal plane, rms of rotation"), 0.0,
              1e-6);
}

TEST(BodyFiguresTest, AKneeThatBendsTooFarDoesNotHold) {
  const auto figures =
      BodyFigures(Walker(95.0, 0.7), {.standing = {}, .sitting = {}, .walks = {{2.0, 12.0}}});
  const auto found = std::find_if(figures.begin(), figures.end(), [](const BodyFigure& figure) {
    return figure.name == "walk 1: right knee, greatest peak of flexion";
  });
  ASSERT_NE(found, figures.end());
  EXPECT_FALSE(found->holds());
  EXPECT_THAT(FiguresText({*found}), HasSubstr("NOT"));
}

TEST(BodyFiguresTest, UprightBentAndTurnedPeopleAreTold) {
  BodyTrace trace = Walker(0.0, 3.0);
  for (BodyFrame& frame : trace.frames) {
    if (frame.time_s >= 10.0) {  // walks back, with thighs out of line by 20° that sit at 15 s
      frame.q_earth_segment.fill(math::ExpSO3({0.0, 0.0, 3.0 - kPi}));
      frame.q_earth_segment[body::Index(Segment::kLeftUpperLeg)] =
          math::ExpSO3({0.0, 0.0, 3.0 - kPi + 20.0 * kPi / 180.0});
    }
    if (frame.time_s >= 15.0) {
      frame.q_earth_segment[body::Index(Segment::kRightUpperLeg)] =
          frame.q_earth_segment[0] * math::ExpSO3({0.0, -80.0 * kPi / 180.0, 0.0});
    }
  }
  const auto figures = BodyFigures(trace, {.standing = TimeSpan{0.0, 5.0},
                                           .sitting = TimeSpan{15.0, 20.0},
                                           .walks = {{0.0, 10.0}, {10.0, 15.0}}});
  EXPECT_NEAR(Value(figures, "standing: head from upright, most"), 0.0, 1e-6);
  EXPECT_NEAR(Value(figures, "sitting: right thigh about trunk"), 80.0, 0.1);
  EXPECT_NEAR(Value(figures, "sitting: right knee"), 80.0, 0.1);
  EXPECT_NEAR(Value(figures, "walks 1 and 2: pelvis turned by"), 180.0, 1e-6);
  EXPECT_NEAR(Value(figures, "walk 2: headings of trunk and legs, greatest difference"), 20.0, 0.1);
}

TEST(BodyFiguresTest, PeaksAreGreatestOfTheirNeighboursAndNotAtTheEnds) {
  EXPECT_THAT(PeaksOf({9, 1, 5, 1, 1, 7, 6, 1, 1, 9}, 4.0, 2), ElementsAre(5));
  EXPECT_THAT(PeaksOf({1, 1, 5, 1, 1, 7, 1, 1, 1, 9}, 4.0, 2), ElementsAre(2, 5));
}

}  // namespace
}  // namespace limbcast::tool
