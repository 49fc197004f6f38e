// Real recordings, as fast as the pipeline takes them: to the end, and every sample accounted for.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/shared_data.hpp"
#include "tests/system/program.hpp"

namespace limbcast {
namespace {

using namespace std::chrono_literals;
using namespace test_support;

struct Play {
  const char* dds;
  std::string recording;
};
void PrintTo(const Play& play, std::ostream* out) { *out << play.dds << ' ' << play.recording; }

std::vector<Play> AllPlays() {
  std::vector<std::string> recordings = {"data/fullbody/walking_fullbody.hdf5"};
  if (const auto folder = SharedPath("data/broad")) {
    for (const auto& entry : std::filesystem::directory_iterator(*folder)) {
      if (entry.path().extension() == ".hdf5") {
        recordings.push_back("data/broad/" + entry.path().filename().string());
      }
    }
  }
  std::sort(recordings.begin(), recordings.end());
  std::vector<Play> plays;
  for (const char* dds : {"cyclone", "fast"}) {
    for (const std::string& recording : recordings) {
      plays.push_back({dds, recording});
    }
  }
  return plays;
}

class RecordingTest : public ::testing::TestWithParam<Play> {};

TEST_P(RecordingTest, IsPlayedToItsEndWithoutLosingASample) {
  LIMBCAST_SKIP_WITHOUT_SHARED(GetParam().recording);
  const DemoRun run = RunDemo(
      {"--dds", GetParam().dds, "--recording", SharedPath(GetParam().recording)->string()}, 150s);
  ASSERT_EQ(run.outcome.status, 0) << Describe(run.outcome);
  SCOPED_TRACE(run.summary.dump(2));
  const Balance balance = BalanceOf(run.summary);
  EXPECT_EQ(balance.published, balance.filtered + balance.refused + balance.lost);
  EXPECT_EQ(balance.lost, 0U);
  const bool full_body = GetParam().recording.find("fullbody") != std::string::npos;
  EXPECT_EQ(run.summary["segments"], full_body ? 16 : 1);
  // 16 sensors for 100 s at 100 Hz; one sensor for 164 to 207 s at 286 Hz.
  EXPECT_GE(balance.published, full_body ? 160'000U : 45'000U);
  // Nobody slows the pipeline down for a client: on a busy machine it may miss skeletons that were
  // emitted, and then says how many.
  EXPECT_GE(run.summary["skeletons"].get<std::uint64_t>() +
                run.summary["skeletons_lost"].get<std::uint64_t>(),
            full_body ? 9'900U : 45'000U);
  EXPECT_TRUE(run.summary["without_last_report"].empty());
  EXPECT_EQ(run.summary["orientation_error_deg"].is_null(), full_body);
}

std::string NameOf(const ::testing::TestParamInfo<Play>& test) {
  std::string name = std::string(test.param.dds) + "_" +
                     std::filesystem::path(test.param.recording).stem().string();
  std::replace_if(
      name.begin(), name.end(), [](char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, RecordingTest, ::testing::ValuesIn(AllPlays()), NameOf);

}  // namespace
}  // namespace limbcast
