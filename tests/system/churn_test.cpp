// People come, go and vanish, services are killed, and nothing is left behind. The long run is
// `limbcast bench churn`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/system/program.hpp"

namespace limbcast {
namespace {

using namespace std::chrono_literals;
using namespace test_support;

class ChurnTest : public ::testing::TestWithParam<const char*> {};

TEST_P(ChurnTest, NothingIsLeftOfWhoWentHome) {
  const TemporaryFolder folder;
  const std::uint32_t domain = OwnDomain();
  const Outcome outcome =
      RunToEnd({Program("limbcast"), "bench", "churn", "--dds", GetParam(), "--domain",
                std::to_string(domain), "--minutes", "0.2", "--count-every", "6", "--action-every",
                "0.4", "--people", "2", "--json", folder / "churn.json"},
               110s);
  ASSERT_EQ(outcome.status, 0) << Describe(outcome);
  std::ifstream file(folder / "churn.json");
  const nlohmann::json report = nlohmann::json::parse(file, nullptr, false);
  ASSERT_TRUE(report.is_object());
  EXPECT_TRUE(report["ok"].get<bool>());
  EXPECT_GE(report["counts"].size(), 2U);
  EXPECT_GT(report["joined"].get<int>(), 2);
  EXPECT_EQ(report["counts"][0]["processes"].size(), 4U) << "session, fusion, posture, client";
  EXPECT_TRUE(ProcessesOnDomain(domain).empty());
}

INSTANTIATE_TEST_SUITE_P(Dds, ChurnTest, ::testing::Values("cyclone", "fast", "mixed"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace limbcast
