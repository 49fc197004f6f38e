#include "tools/limbcast/calibrate/calibration_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/common/sensing/calibration_scene.hpp"

namespace limbcast::tool {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
namespace scene = sensing::scene;

NamedReport Guided() {
  const auto samples = scene::Read(scene::GuidedPoses(false, 1), scene::FactoryErrors(), 1);
  return {.name = "<pelvis>",
          .report = sensing::CalibrateSensor(samples, {.field_tesla = scene::kField_tesla})};
}

TEST(CalibrationReportTest, TheTextSaysMethodCoverageAndGrade) {
  const std::string text = CalibrationText(Guided());
  EXPECT_THAT(text, HasSubstr("26 poses at rest"));
  EXPECT_THAT(text, HasSubstr("25.0 °C"));
  EXPECT_THAT(text, HasSubstr("accel  ellipsoid"));
  EXPECT_THAT(text, HasSubstr("mag    ellipsoid-aligned"));
  EXPECT_THAT(text, HasSubstr("gyro   carried-direction"));
  EXPECT_THAT(text, HasSubstr("good"));
  EXPECT_THAT(text, Not(HasSubstr("refused")));
}

TEST(CalibrationReportTest, ARefusalSaysWhatIsMissing) {
  const std::string text =
      CalibrationText({.name = "a", .report = sensing::CalibrateSensor({}, {})});
  EXPECT_THAT(
      text, HasSubstr("accel  refused\n         at rest: different positions must be at least 12"));
  EXPECT_THAT(text, HasSubstr("no time at rest"));
}

TEST(CalibrationReportTest, ThePageHoldsMapsAndEscapesNames) {
  const std::vector<NamedReport> sensors = {Guided()};
  const std::string html = CalibrationHtml(sensors, {});
  EXPECT_THAT(html, HasSubstr("&lt;pelvis>"));
  EXPECT_THAT(html, Not(HasSubstr("<pelvis>")));
  EXPECT_THAT(html, HasSubstr("<svg"));
  EXPECT_THAT(html, HasSubstr("magnetometer</h3>"));
  EXPECT_THAT(html, Not(HasSubstr("nan")));
  EXPECT_LT(html.size(), 1'000'000U);
}

TEST(CalibrationReportTest, TheSessionNamesWhoSeesADisturbedField) {
  const sensing::SessionReference good{.gravity_m_s2 = 9.81, .field_tesla = 48e-6, .dip_rad = 1.1};
  sensing::SessionReference bad = good;
  bad.field_tesla = 70e-6;
  const std::vector<NamedReference> sensors = {
      {.name = "pelvis", .reference = good, .refusal = {}},
      {.name = "head", .reference = {}, .refusal = "never still"},
      {.name = "left_foot", .reference = bad, .refusal = {}},
      {.name = "sternum", .reference = good, .refusal = {}}};
  const std::string text = SessionText(sensors, {});
  EXPECT_THAT(text, HasSubstr("gravity 9.810 m/s², field 48.0 µT, dip 63.0°"));
  EXPECT_THAT(text, HasSubstr("pelvis                   undisturbed"));
  EXPECT_THAT(text, HasSubstr("head                     never still"));
  EXPECT_THAT(text, HasSubstr("left_foot                DISTURBED: field 70.0 uT"));

  const auto settings = SessionToml(sensors, {.declination_rad = 0.0733038});
  ASSERT_TRUE(settings.ok());
  EXPECT_THAT(*settings, HasSubstr("declination_deg = 4.200\n"));
  EXPECT_THAT(*settings, HasSubstr("reference_field_tesla = 4.8000e-05\n"));
  EXPECT_THAT(*settings, HasSubstr("reference_dip_rad = 1.10000\n"));
}

TEST(CalibrationReportTest, WithoutAMagnetometerThereAreNoSessionSettings) {
  const std::vector<NamedReference> sensors = {
      {.name = "pelvis", .reference = {.gravity_m_s2 = 9.81}, .refusal = {}},
      {.name = "head", .reference = {.field_tesla = 48e-6}, .refusal = "never still"}};
  const auto settings = SessionToml(sensors, {});
  ASSERT_FALSE(settings.ok());
  EXPECT_THAT(settings.error().message, HasSubstr("no field to write"));
}

}  // namespace
}  // namespace limbcast::tool
