#include "common/sensing/session_reference.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/unit/common/sensing/calibration_scene.hpp"

namespace limbcast::sensing {
namespace {

TEST(SessionReferenceTest, MeasuresGravityFieldAndDipAtRest) {
  const auto samples = scene::Read(scene::RandomPoses(3, 1), {}, 1);
  const auto reference = MeasureSessionReference(samples, {.declination_rad = 0.05});
  ASSERT_TRUE(reference.ok());
  EXPECT_NEAR(reference->gravity_m_s2, simulation::kGravity_m_s2, 1e-5);
  EXPECT_NEAR(reference->field_tesla, scene::kField_tesla, 1e-11);
  EXPECT_NEAR(reference->dip_rad, scene::kDip_rad, 1e-5);
  EXPECT_EQ(reference->declination_rad, 0.05);
  EXPECT_GT(reference->rest_s, 1.5);
}

TEST(SessionReferenceTest, WithoutRestThereIsNoReference) {
  auto samples = scene::Read(scene::RandomPoses(2, 2), {}, 2);
  samples.erase(samples.begin(), samples.begin() + 200);  // begins with the turn
  const auto reference = MeasureSessionReference(samples, {.window_s = 1.5});
  ASSERT_FALSE(reference.ok());
  EXPECT_EQ(reference.error().message,
            "the sensor was never still in the first 1.5 s: stand still at the begin");
  EXPECT_FALSE(MeasureSessionReference({}, {}).ok());
}

TEST(SessionReferenceTest, TheSensorBesideIronIsNamedAndTheOthersAreNot) {
  std::vector<SessionReference> sensors(
      5, {.gravity_m_s2 = 9.81, .field_tesla = 48e-6, .dip_rad = 1.1});
  sensors[2].field_tesla = 60e-6;
  sensors[3].dip_rad = 0.9;
  sensors[4].field_tesla = 0.0;  // no magnetometer
  const auto verdicts = JudgeField(sensors, {});
  ASSERT_EQ(verdicts.size(), 5U);
  EXPECT_FALSE(verdicts[0].disturbed);
  EXPECT_FALSE(verdicts[1].disturbed);
  EXPECT_EQ(verdicts[2].reason, "field 60.0 uT, expected 48.0 uT");
  EXPECT_EQ(verdicts[3].reason, "dip 51.6 deg, expected 63.0 deg");
  EXPECT_FALSE(verdicts[4].disturbed);
}

TEST(SessionReferenceTest, AnExpectedFieldWinsOverTheMedian) {
  const std::vector<SessionReference> sensors(3, {.gravity_m_s2 = 9.81, .field_tesla = 70e-6});
  const SessionConfig config{.expected_field_tesla = 48e-6};
  EXPECT_EQ(CommonReference(sensors, config).field_tesla, 48e-6);
  EXPECT_TRUE(JudgeField(sensors, config)[0].disturbed);
  EXPECT_EQ(CommonReference({}, config).field_tesla, 0.0);
}

}  // namespace
}  // namespace limbcast::sensing
