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

  TemporaryFolder folder_;
  std::uint32_t domain_ = 0;
  std::unique_ptr<process::ChildProcess> demo_;
  std::unique_ptr<bus::Bus> bus_;
  std::unique_ptr<tool::PipelineView> view_;
};

TEST_P(KillTest, OthersGoOnAndTheSuccessorIsPickedUp) {
  const auto pids = [&] {
    return std::array{ProcessOnDomain(domain_, "limbcast-gateway"),
                      ProcessOnDomain(domain_, "limbcast-fusion"),
                      ProcessOnDomain(domain_, "limbcast-posture")};
  };
  const auto first = pids();
  ASSERT_NO_FATAL_FAILURE(KillAndRecover("limbcast-fusion"));
  const auto second = pids();
  EXPECT_EQ(second[0], first[0]);
  EXPECT_NE(second[1], first[1]);
  EXPECT_EQ(second[2], first[2]);
  ASSERT_NO_FATAL_FAILURE(KillAndRecover("limbcast-posture"));
  ASSERT_NO_FATAL_FAILURE(KillAndRecover("limbcast-gateway"));
  const auto last = pids();
  EXPECT_EQ(last[1], second[1]) << "only who was killed is another one";
  EXPECT_NE(last[0], first[0]);
  EXPECT_NE(last[2], first[2]);

  demo_->Signal(SIGINT);
  const auto ended = demo_->Wait(30s);
  ASSERT_TRUE(ended.has_value());
  EXPECT_EQ(ended->status, 0) << demo_->Output() << demo_->Errors();
  std::ifstream file(folder_ / "summary.json");
  const nlohmann::json summary = nlohmann::json::parse(file, nullptr, false);
  ASSERT_TRUE(summary.is_object());
  SCOPED_TRACE(summary.dump(2));
  EXPECT_EQ(summary["restarts"], nlohmann::json({{"fusion", 1}, {"posture", 1}, {"gateway", 1}}));
  const Balance balance = BalanceOf(summary);
  EXPECT_EQ(balance.published, balance.filtered + balance.refused + balance.lost);
  EXPECT_GT(balance.lost, 0U) << "the gap of fusion is visible";
  EXPECT_TRUE(ProcessesOnDomain(domain_).empty());
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
