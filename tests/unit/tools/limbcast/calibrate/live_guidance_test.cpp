#include "tools/limbcast/calibrate/live_guidance.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/common/sensing/calibration_scene.hpp"

namespace limbcast::tool {
namespace {

using ::testing::HasSubstr;
namespace scene = sensing::scene;

LiveGuidance After(const std::vector<sensing::MargSample>& samples) {
  LiveGuidance guidance;
  for (const sensing::MargSample& sample : samples) {
    guidance.Add(sample);
  }
  return guidance;
}

TEST(LiveGuidanceTest, AtTheBeginItAsksForTheFirstSide) {
  EXPECT_EQ(
      LiveGuidance().Line(),
      "0 poses, up: .. .. .. .. .. .., gravity 0 %, no magnetometer; hold still for 1 s: next +x "
      "up");
}

TEST(LiveGuidanceTest, SidesAreTickedOffAndTheNextIsNamed) {
  auto handling = scene::SixFaces(0.0, 0.0, 1);
  handling.poses.pop_back();  // −z is left
  const LiveGuidance guidance = After(scene::Read(handling, scene::FactoryErrors(), 1));
  EXPECT_EQ(guidance.poses(), 5U);
  EXPECT_FALSE(guidance.complete());
  EXPECT_THAT(guidance.Line(), HasSubstr("5 poses, up: +x -x +y -y +z .."));
  EXPECT_THAT(guidance.Line(), HasSubstr("next -z up"));
}

TEST(LiveGuidanceTest, GuidedPosesAreEnough) {
  const auto samples = scene::Read(scene::GuidedPoses(false, 2), scene::FactoryErrors(), 2);
  const LiveGuidance guidance = After(samples);
  EXPECT_TRUE(guidance.complete()) << guidance.Line();
  EXPECT_THAT(guidance.Line(), HasSubstr("enough"));
  EXPECT_EQ(guidance.samples().size(), samples.size());
}

TEST(LiveGuidanceTest, StayingInOnePoseIsOnePose) {
  scene::Handling handling = scene::RandomPoses(1, 3);
  handling.rest_s = 20.0;
  const LiveGuidance guidance = After(scene::Read(handling, scene::FactoryErrors(), 3));
  EXPECT_EQ(guidance.poses(), 1U);
  EXPECT_THAT(guidance.Line(), HasSubstr("field 0 %")) << "noise is no coverage";
}

}  // namespace
}  // namespace limbcast::tool
