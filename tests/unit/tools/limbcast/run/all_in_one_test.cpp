#include "tools/limbcast/run/all_in_one.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "common/bus/bus_factory.hpp"
#include "common/runtime/stop_signal.hpp"
#include "common/runtime/system_clock.hpp"
#include "tools/limbcast/monitor/pipeline_view.hpp"

namespace limbcast::tool {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

Result<AllInOneConfig> Read(const char* text) {
  const auto file = config::ConfigFile::Parse(text, "all.toml");
  return ReadAllInOne(file.value());
}

TEST(AllInOneTest, RefusesWhatAnyOfTheServicesRefuses) {
  EXPECT_TRUE(Read("").ok());
  const auto refused = Read("[filter]\nname = \"magic\"\n");
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("magic"));
}

TEST(AllInOneTest, PlaysASimulationToItsEndWithEverySampleAccountedFor) {
  bus::BusConfig bus_config;
  bus_config.vendor = bus::Vendor::kInproc;
  bus_config.partition = "all_in_one_test";
  const auto bus = bus::Open(bus_config).value();
  const runtime::SystemClock clock;
  const auto view = PipelineView::Make(*bus, {.segment_states = false, .truth = true}).value();
  runtime::StopSignal stop;

  const auto config = Read(
      "[gateway]\nspeed = \"max\"\nexit_at_end = true\nwait_for = \"posture\"\n"
      "[simulator]\nduration_s = 1.0\nsensors = \"reduced15\"\n");
  ASSERT_TRUE(config.ok()) << config.error().message;
  const auto all =
      AllInOne::Make(*config, clock, *bus, nullptr, [&stop] { stop.Trigger(); }).value();
  ASSERT_TRUE(all->Start().ok());
  ASSERT_TRUE(stop.WaitFor(30s));
  all->Stop();

  EXPECT_TRUE(all->result().ok());
  const std::uint64_t published =
      all->Summary().published.marg + all->Summary().published.orientation;
  EXPECT_GE(published, 15U * 99U);
  view->With([&](const PipelineModel& model) {
    const Accounting account = Account(model.health);
    EXPECT_EQ(account.published, published);
    EXPECT_EQ(account.filtered, published);
    EXPECT_EQ(account.lost, 0U);
    EXPECT_TRUE(account.refused.empty());
    // One for each tick; nothing is tracked while the filters start, and before that for probes.
    EXPECT_GE(model.skeletons() + model.probe_skeletons, published / 15U);
    EXPECT_GE(model.skeletons(), 40U);
    EXPECT_EQ(model.bodies.begin()->second.lost, 0U);
  });
}

}  // namespace
}  // namespace limbcast::tool
