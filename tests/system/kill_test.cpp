// kill -9 of one process after the other: the others go on, the new one is picked up, and the gap
// is visible.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <fstream>
#include <memory>
#include <string>

#include "common/bus/bus_factory.hpp"
#include "tests/system/program.hpp"
#include "tools/limbcast/monitor/pipeline_view.hpp"

namespace limbcast {
namespace {

using namespace std::chrono_literals;
using namespace test_support;

// Ticks come every 10 ms. How many are missed depends on how fast a process starts: it was five on
// a quiet machine, and at least one.
constexpr double kTickMissed_s = 0.015;

class KillTest : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    domain_ = OwnDomain();
    auto demo = process::ChildProcess::Start(
        {.arguments = {Program("limbcast"), "demo", "--dds", GetParam(), "--domain",
                       std::to_string(domain_), "--json", folder_ / "summary.json"}});
    ASSERT_TRUE(demo.ok());
    demo_ = std::make_unique<process::ChildProcess>(std::move(*demo));

    bus::BusConfig config;
    config.vendor = GetParam() == std::string("fast") ? bus::Vendor::kFast : bus::Vendor::kCyclone;
    config.domain_id = domain_;
    bus_ = bus::Open(config).value();
    view_ = tool::PipelineView::Make(*bus_, {.segment_states = false, .truth = false}).value();
    ASSERT_TRUE(Eventually(30s, [&] { return Skeletons() > 50; })) << demo_->Errors();
  }

  [[nodiscard]] std::uint64_t Skeletons() {
    return view_->With([](const tool::PipelineModel& model) { return model.skeletons(); });
  }

  // Kills `victim`, waits for its successor and for skeletons to flow again.
  void KillAndRecover(const std::string& victim) {
    SCOPED_TRACE(victim);
    const pid_t before = ProcessOnDomain(domain_, victim);
    ASSERT_NE(before, 0);
    ASSERT_EQ(kill(before, SIGKILL), 0);
    ASSERT_TRUE(Eventually(15s, [&] {
      const pid_t now = ProcessOnDomain(domain_, victim);
      return now != 0 && now != before;
    }));
    const std::uint64_t skeletons = Skeletons();
    ASSERT_TRUE(Eventually(20s, [&] { return Skeletons() > skeletons + 100; }))
        << "no skeletons after the restart";
  }

  // As Ctrl-C does; the summary.
  [[nodiscard]] nlohmann::json EndDemo() {
    demo_->Signal(SIGINT);
    const auto ended = demo_->Wait(30s);
    EXPECT_TRUE(ended.has_value() && ended->clean()) << demo_->Output() << demo_->Errors();
    EXPECT_TRUE(ProcessesOnDomain(domain_).empty());
    std::ifstream file(folder_ / "summary.json");
    nlohmann::json summary = nlohmann::json::parse(file, nullptr, false);
    EXPECT_TRUE(summary.is_object());
    if (summary.is_object()) {
      const Balance balance = BalanceOf(summary);
      EXPECT_EQ(balance.published, balance.filtered + balance.refused + balance.lost);
    }
    return summary;
  }

  TemporaryFolder folder_;
  std::uint32_t domain_ = 0;
  std::unique_ptr<process::ChildProcess> demo_;
  std::unique_ptr<bus::Bus> bus_;
  std::unique_ptr<tool::PipelineView> view_;
};

TEST_P(KillTest, FusionIsReplacedAndItsGapIsCounted) {
  const pid_t gateway = ProcessOnDomain(domain_, "limbcast-gateway");
  const pid_t posture = ProcessOnDomain(domain_, "limbcast-posture");
  ASSERT_NO_FATAL_FAILURE(KillAndRecover("limbcast-fusion"));
  EXPECT_EQ(ProcessOnDomain(domain_, "limbcast-gateway"), gateway);
  EXPECT_EQ(ProcessOnDomain(domain_, "limbcast-posture"), posture);

  const nlohmann::json summary = EndDemo();
  SCOPED_TRACE(summary.dump(2));
  EXPECT_EQ(summary["restarts"], nlohmann::json({{"fusion", 1}}));
  EXPECT_GT(BalanceOf(summary).lost, 0U);
  EXPECT_GT(summary["longest_skeleton_gap_s"].get<double>(), kTickMissed_s);
}

TEST_P(KillTest, PostureAndGatewayAreReplacedAndTheGapIsSeen) {
  const pid_t fusion = ProcessOnDomain(domain_, "limbcast-fusion");
  ASSERT_NO_FATAL_FAILURE(KillAndRecover("limbcast-posture"));
  ASSERT_NO_FATAL_FAILURE(KillAndRecover("limbcast-gateway"));
  EXPECT_EQ(ProcessOnDomain(domain_, "limbcast-fusion"), fusion);

  const nlohmann::json summary = EndDemo();
  SCOPED_TRACE(summary.dump(2));
  EXPECT_EQ(summary["restarts"], nlohmann::json({{"posture", 1}, {"gateway", 1}}));
  EXPECT_GT(summary["longest_skeleton_gap_s"].get<double>(), kTickMissed_s);
}

TEST_P(KillTest, NothingIsLeftWhenTheDemoItselfIsKilled) {
  ASSERT_EQ(ProcessesOnDomain(domain_).size(), 4U);
  demo_->Signal(SIGKILL);
  ASSERT_TRUE(demo_->Wait(10s).has_value());
  EXPECT_TRUE(Eventually(10s, [&] { return ProcessesOnDomain(domain_).empty(); }));
}

INSTANTIATE_TEST_SUITE_P(Dds, KillTest, ::testing::Values("cyclone", "fast"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace limbcast
