// What a user gets wrong: one line that names the thing, the value and the limit, status 2, at
// once.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/support/shared_data.hpp"
#include "tests/system/program.hpp"

namespace limbcast {
namespace {

using namespace test_support;
using ::testing::HasSubstr;
using ::testing::StartsWith;

void ExpectRefusal(const Outcome& outcome, const std::string& program,
                   const std::vector<std::string>& words) {
  SCOPED_TRACE(Describe(outcome));
  EXPECT_FALSE(outcome.timed_out);
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.signal, 0);
  EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1);
  EXPECT_THAT(outcome.errors, StartsWith(program + ": "));
  for (const std::string& word : words) {
    EXPECT_THAT(outcome.errors, HasSubstr(word));
  }
}

class AnyProgramTest : public ::testing::TestWithParam<const char*> {
 protected:
  // `limbcast` does nothing without a command.
  [[nodiscard]] std::vector<std::string> Line(std::vector<std::string> more) const {
    std::vector<std::string> arguments = {Program(GetParam())};
    if (GetParam() == std::string("limbcast")) {
      arguments.emplace_back("top");
    }
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  void Refuses(std::vector<std::string> more, const std::vector<std::string>& words) const {
    ExpectRefusal(RunToEnd(Line(std::move(more))), GetParam(), words);
  }
  TemporaryFolder folder_;
};

TEST_P(AnyProgramTest, UnknownOption) { Refuses({"--frobnicate"}, {"--frobnicate"}); }
TEST_P(AnyProgramTest, OptionWithoutItsValue) { Refuses({"--domain"}, {"--domain"}); }
TEST_P(AnyProgramTest, NumberThatIsNone) { Refuses({"--domain", "seven"}, {"--domain", "seven"}); }
TEST_P(AnyProgramTest, DomainOutOfRange) { Refuses({"--domain", "102"}, {"domain", "102", "101"}); }
TEST_P(AnyProgramTest, UnknownDds) { Refuses({"--dds", "zenoh"}, {"zenoh", "cyclone", "fast"}); }
TEST_P(AnyProgramTest, ConfigThatIsNotThere) {
  Refuses({"--config", "/nowhere/x.toml"}, {"/nowhere/x.toml"});
}
TEST_P(AnyProgramTest, ConfigThatIsAFolder) {
  Refuses({"--config", std::filesystem::temp_directory_path()},
          {std::filesystem::temp_directory_path()});
}

TEST_P(AnyProgramTest, ConfigThatIsNoToml) {
  const auto path = folder_ / "broken.toml";
  std::ofstream(path) << "[bus]\ndomain_id = \n";
  Refuses({"--config", path}, {"broken.toml:2"});
}

TEST_P(AnyProgramTest, UnknownKeyInConfig) {
  const auto path = folder_ / "unknown.toml";
  std::ofstream(path) << "[bus]\ndomian_id = 7\n";
  Refuses({"--config", path}, {"unknown.toml:2", "domian_id"});
}

TEST_P(AnyProgramTest, ValueOutOfRangeInConfig) {
  const auto path = folder_ / "range.toml";
  std::ofstream(path) << "[bus]\nstream_depth = 0\n";
  Refuses({"--config", path}, {"range.toml:2", "stream_depth", "[1, 1024]", "0"});
}

TEST_P(AnyProgramTest, HelpAndVersionAreNoErrors) {
  const Outcome help = RunToEnd({Program(GetParam()), "--help"});
  EXPECT_EQ(help.status, 0) << Describe(help);
  EXPECT_THAT(help.output, HasSubstr("Examples:"));
  EXPECT_EQ(help.errors, "");
  const Outcome version = RunToEnd({Program(GetParam()), "--version"});
  EXPECT_EQ(version.status, 0);
  EXPECT_THAT(version.output, StartsWith(std::string(GetParam()) + " "));
}

INSTANTIATE_TEST_SUITE_P(Programs, AnyProgramTest,
                         ::testing::Values("limbcast", "limbcast-gateway", "limbcast-fusion",
                                           "limbcast-posture"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(LimbcastProgramTest, MissingAndUnknownCommands) {
  ExpectRefusal(RunToEnd({Program("limbcast")}), "limbcast", {"command"});
  ExpectRefusal(RunToEnd({Program("limbcast"), "dance"}), "limbcast", {"dance"});
  ExpectRefusal(RunToEnd({Program("limbcast"), "echo", "marge"}), "limbcast", {"marge", "marg,"});
  ExpectRefusal(RunToEnd({Program("limbcast"), "demo", "--dds", "iceoryx"}), "limbcast",
                {"iceoryx", "mixed"});
  ExpectRefusal(RunToEnd({Program("limbcast"), "demo", "--seconds", "-1"}), "limbcast",
                {"--seconds", "-1"});
  ExpectRefusal(RunToEnd({Program("limbcast"), "demo", "--recording", "/nowhere.hdf5"}), "limbcast",
                {"/nowhere.hdf5"});
  ExpectRefusal(RunToEnd({Program("limbcast"), "demo", "--json", "/nowhere/x.json"}), "limbcast",
                {"/nowhere/x.json"});
}

TEST(ServiceSettingsTest, RangesAndNamesOfTheirOwnTables) {
  ExpectRefusal(RunToEnd({Program("limbcast-fusion"), "--set", "fusion.workers=0"}),
                "limbcast-fusion", {"fusion.workers", "[1, 64]", "0"});
  ExpectRefusal(RunToEnd({Program("limbcast-fusion"), "--set", "filter.name=magic"}),
                "limbcast-fusion", {"magic"});
  ExpectRefusal(RunToEnd({Program("limbcast-posture"), "--set", "posture.body_height_m=9"}),
                "limbcast-posture", {"posture.body_height_m", "2.5", "9"});
  ExpectRefusal(RunToEnd({Program("limbcast-gateway"), "--set", "simulator.rate_hz=0"}),
                "limbcast-gateway", {"simulator.rate_hz", "[1, 1000]", "0"});
  ExpectRefusal(RunToEnd({Program("limbcast-gateway"), "--set", "gateway.driver=telepathy"}),
                "limbcast-gateway", {"gateway.driver", "telepathy"});
}

class BadRecordingTest : public ::testing::Test {
 protected:
  void Refuses(const std::filesystem::path& path, const std::vector<std::string>& words) const {
    ExpectRefusal(RunToEnd({Program("limbcast-gateway"), "--recording", path}), "limbcast-gateway",
                  words);
  }
  TemporaryFolder folder_;
};

TEST_F(BadRecordingTest, NotThere) { Refuses("/nowhere/x.hdf5", {"/nowhere/x.hdf5"}); }

TEST_F(BadRecordingTest, UnreadableFile) {
  if (geteuid() == 0) {
    GTEST_SKIP() << "skipped: root may read everything";
  }
  const auto path = folder_ / "secret.csv";
  std::ofstream(path) << "time_s\n";
  std::filesystem::permissions(path, std::filesystem::perms::none);
  Refuses(path, {"secret.csv"});
}

TEST_F(BadRecordingTest, EmptyFile) {
  const auto path = folder_ / "empty.hdf5";
  std::ofstream(path) << "";
  Refuses(path, {"empty.hdf5"});
}

TEST_F(BadRecordingTest, GarbageThatCallsItselfHdf5) {
  const auto path = folder_ / "garbage.hdf5";
  std::ofstream(path) << std::string(5000, 'x');
  Refuses(path, {"garbage.hdf5"});
}

TEST_F(BadRecordingTest, TruncatedHdf5) {
  const char* const name = "data/fullbody/walking_fullbody.hdf5";
  LIMBCAST_SKIP_WITHOUT_SHARED(name);
  std::ifstream whole(*SharedPath(name), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(whole), std::istreambuf_iterator<char>()};
  const auto path = folder_ / "truncated.hdf5";
  for (const std::size_t size : {bytes.size() / 2, bytes.size() - 1, std::size_t{100}}) {
    SCOPED_TRACE(size);
    std::ofstream(path, std::ios::binary) << bytes.substr(0, size);
    Refuses(path, {"truncated.hdf5"});
  }
}

TEST_F(BadRecordingTest, WrongUnitsColumn) {
  const auto path = folder_ / "units.csv";
  std::ofstream(path) << "time_s,sensor,gyro_x_deg_s,gyro_y_deg_s,gyro_z_deg_s\n0,a,1,2,3\n";
  Refuses(path, {"units.csv", "gyro_x_deg_s", "gyro_x_rad_s"});
}

TEST_F(BadRecordingTest, RowThatIsTooShort) {
  const auto path = folder_ / "short.csv";
  std::ofstream(path) << "time_s,sensor,gyro_x_rad_s,gyro_y_rad_s,gyro_z_rad_s\n0,a,1,2,3\n1,a,1\n";
  Refuses(path, {"short.csv"});
}

TEST_F(BadRecordingTest, TextWhereANumberBelongs) {
  const auto path = folder_ / "text.csv";
  std::ofstream(path) << "time_s,sensor,gyro_x_rad_s,gyro_y_rad_s,gyro_z_rad_s\n0,a,1,two,3\n";
  Refuses(path, {"text.csv", "two"});
}

}  // namespace
}  // namespace limbcast
