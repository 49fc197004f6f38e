// `limbcast evaluate` as a user meets it: what it writes, and what it refuses in one line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/system/program.hpp"

namespace limbcast {
namespace {

using namespace test_support;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kRecording = LIMBCAST_SOURCE_DIR "/tests/golden/left_fore_arm.csv";

Outcome Evaluate(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {Program("limbcast"), "evaluate"});
  return RunToEnd(arguments, std::chrono::seconds(60));
}

std::string TextOf(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void ExpectRefusal(const std::vector<std::string>& arguments,
                   const std::vector<std::string>& words) {
  const Outcome outcome = Evaluate(arguments);
  SCOPED_TRACE(Describe(outcome));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1);
  EXPECT_THAT(outcome.errors, StartsWith("limbcast"));
  for (const std::string& word : words) {
    EXPECT_THAT(outcome.errors, HasSubstr(word));
  }
}

TEST(EvaluateTest, WritesARowForEachSampleFiguresAndAReport) {
  const TemporaryFolder folder;
  const Outcome outcome = Evaluate({"orientation", "--data", kRecording, "--filter", "tqt,bmf",
                                    "--set", "bmf.output_lead_s=0.004", "--out", folder / "out",
                                    "--json", folder / "figures.json"});
  ASSERT_EQ(outcome.status, 0) << Describe(outcome);
  EXPECT_EQ(outcome.errors, "");  // no progress bar where nobody watches
  EXPECT_THAT(outcome.output, HasSubstr("output lead is not 0: bmf.output_lead_s=0.004"));
  EXPECT_THAT(outcome.output, HasSubstr("NEES"));
  for (const char* filter : {"tqt", "bmf"}) {
    const std::string csv = TextOf(folder / "out" / filter / "left_fore_arm.csv");
    EXPECT_THAT(csv, StartsWith("w,x,y,z\n"));
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1001);
  }
  EXPECT_THAT(TextOf(folder / "out" / "report.html"), HasSubstr("<svg"));
  const auto json = nlohmann::json::parse(TextOf(folder / "figures.json"));
  EXPECT_LT(json["filters"]["bmf"]["all"]["total_deg"].get<double>(), 5.0);
}

TEST(EvaluateTest, RefusesWithOneLine) {
  ExpectRefusal({"orientation"}, {"--data"});
  ExpectRefusal({"orientation", "--data", "/nowhere"}, {"/nowhere"});
  ExpectRefusal({"orientation", "--data", "/proc/self/attr"}, {"/proc/self/attr", "no recording"});
  ExpectRefusal({"orientation", "--data", kRecording, "--filter", "bfm"}, {"bfm", "bmf", "tqt"});
  ExpectRefusal({"orientation", "--data", kRecording, "--set", "r_m=1"}, {"r_m"});
  ExpectRefusal({"orientation", "--data", kRecording, "--set", "bfm.init_time_s=1"}, {"bfm"});
  ExpectRefusal({"orientation", "--data", kRecording, "--set", "init_time_s=99"},
                {"99", "[0, 10]"});
  ExpectRefusal({"orientation", "--data", kRecording, "--set", "init_time_s"}, {"key=value"});
  ExpectRefusal({"orientation", "--data", kRecording, "--out", "/proc/x"}, {"/proc/x"});
  ExpectRefusal({"orientation", "--data", kRecording, "--json", "/proc/x"}, {"/proc/x"});
  ExpectRefusal({"published", "--only", "static", "--filter", "nonesuch"}, {"nonesuch"});
  ExpectRefusal({"published", "--only", "nonesuch"}, {"nonesuch", "assembly"});
  ExpectRefusal({"published", "--trials", "0"}, {"--trials", "0"});
}

TEST(EvaluateTest, PublishedFiguresStandBesideTheSimulatedOnes) {
  const TemporaryFolder folder;
  const Outcome outcome =
      Evaluate({"published", "--only", "assembly", "--trials", "1", "--seed", "7", "--filter",
                "bmf,gyro", "--json", folder / "figures.json"});
  ASSERT_EQ(outcome.status, 0) << Describe(outcome);
  EXPECT_THAT(outcome.output, HasSubstr("19.8"));
  const auto json = nlohmann::json::parse(TextOf(folder / "figures.json"));
  EXPECT_EQ(json["seed"], 7);
  ASSERT_EQ(json["figures"].size(), 1U);
  EXPECT_GT(json["figures"][0]["simulated"]["bmf"]["mean_deg"].get<double>(), 0.0);
}

}  // namespace
}  // namespace limbcast
