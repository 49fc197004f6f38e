// `limbcast calibrate` as a user meets it: from a recording of a sensor turned by hand to a file
// that the gateway takes, and what is refused in one line.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/system/program.hpp"
#include "tests/unit/common/sensing/calibration_scene.hpp"

namespace limbcast {
namespace {

using namespace test_support;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;
namespace scene = sensing::scene;

Outcome Calibrate(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {Program("limbcast"), "calibrate"});
  return RunToEnd(arguments, std::chrono::seconds(60));
}

std::string TextOf(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void WriteCsv(const std::filesystem::path& path, const scene::Handling& handling) {
  std::ofstream csv(path);
  csv << "time_s,sensor,segment,gyro_x_rad_s,gyro_y_rad_s,gyro_z_rad_s,accel_x_m_s2,accel_y_m_s2,"
         "accel_z_m_s2,mag_x_tesla,mag_y_tesla,mag_z_tesla,temperature_celsius\n";
  for (const sensing::MargSample& s :
       scene::Read(handling, scene::FactoryErrors(), simulation::kDefaultSeed)) {
    csv << fmt::format("{:.3f},imu7,head,{},{},{},{},{},{},{},{},{},{}\n",
                       ToSeconds(s.measured_at - Time{}), s.gyro_rad_s.x(), s.gyro_rad_s.y(),
                       s.gyro_rad_s.z(), s.accel_m_s2.x(), s.accel_m_s2.y(), s.accel_m_s2.z(),
                       s.mag_tesla.x(), s.mag_tesla.y(), s.mag_tesla.z(), s.temperature_celsius);
  }
}

TEST(CalibrateTest, ARecordingBecomesAFileThatTheGatewayTakes) {
  const TemporaryFolder folder;
  WriteCsv(folder / "turns.csv", scene::GuidedPoses(true, simulation::kDefaultSeed));
  const Outcome outcome =
      Calibrate({"sensor", "--recording", folder / "turns.csv", "--level", "--field-ut", "48.6",
                 "--out", folder / "cal", "--report", folder / "page.html"});
  ASSERT_EQ(outcome.status, 0) << Describe(outcome);
  EXPECT_THAT(outcome.output,
              AllOf(HasSubstr("imu7"), HasSubstr("on head"), HasSubstr("26 poses at rest"),
                    HasSubstr("ellipsoid-level"), HasSubstr("carried-direction")));
  EXPECT_THAT(TextOf(folder / "page.html"), HasSubstr("<svg"));
  EXPECT_THAT(TextOf(folder / "cal" / "turns%2Fimu7.toml"),
              AllOf(HasSubstr("temperature_celsius = 25"), HasSubstr("whole = true")));

  const Outcome gateway =
      RunToEnd({Program("limbcast-gateway"), "--recording", folder / "turns.csv", "--speed", "1000",
                "--exit-at-end", "--domain", std::to_string(OwnDomain()), "--set",
                "gateway.calibration_folder=\"" + (folder / "cal").string() + "\""},
               std::chrono::seconds(60));
  EXPECT_EQ(gateway.status, 0) << Describe(gateway);
  EXPECT_THAT(gateway.errors + gateway.output, HasSubstr("1 of 1 sensors")) << Describe(gateway);
}

TEST(CalibrateTest, TooLittleIsRefusedSayingWhatIsMissing) {
  const TemporaryFolder folder;
  WriteCsv(folder / "few.csv", scene::RandomPoses(3, 1));
  const Outcome outcome =
      Calibrate({"sensor", "--recording", folder / "few.csv", "--out", folder / "cal"});
  EXPECT_EQ(outcome.status, 0) << "the gyro's null is known: " << Describe(outcome);
  EXPECT_THAT(outcome.output, AllOf(HasSubstr("accel  refused"),
                                    HasSubstr("different positions must be at least 12, are 3"),
                                    HasSubstr("null-at-rest")));
}

TEST(CalibrateTest, WrongWordsAreRefusedInOneLine) {
  const TemporaryFolder folder;
  WriteCsv(folder / "few.csv", scene::RandomPoses(2, 1));
  for (const auto& [arguments, word] :
       {std::pair<std::vector<std::string>, std::string>{{"sensor", "--recording", "/nowhere.csv"},
                                                         "/nowhere.csv"},
        {{"sensor", "--recording", folder / "few.csv", "--sensor", "left"}, "there are: imu7"},
        {{"sensor", "--method", "magic"}, "--method"},
        {{"sensor", "--gravity", "1.6"}, "--gravity"}}) {
    const Outcome outcome = Calibrate(arguments);
    SCOPED_TRACE(Describe(outcome));
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1);
    EXPECT_THAT(outcome.errors, AllOf(StartsWith("limbcast"), HasSubstr(word)));
  }
}

TEST(CalibrateTest, TheSessionSaysWhatGravityAndFieldAre) {
  const TemporaryFolder folder;
  WriteCsv(folder / "few.csv", scene::RandomPoses(2, 1));
  const Outcome outcome =
      Calibrate({"session", "--recording", folder / "few.csv", "--declination-deg", "4.2"});
  EXPECT_EQ(outcome.status, 0) << Describe(outcome);
  EXPECT_THAT(outcome.output,
              AllOf(HasSubstr("gravity"), HasSubstr("declination 4.2"), HasSubstr("on head")));
}

}  // namespace
}  // namespace limbcast
