#include "services/gateway/gateway_service.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <future>

#include "common/bus/inproc/inproc_bus.hpp"
#include "common/runtime/system_clock.hpp"
#include "common/runtime/thread_pool.hpp"
#include "tests/support/fake_clock.hpp"
#include "tests/support/immediate_pool.hpp"
#include "tests/unit/services/gateway/fake_driver.hpp"
#include "tests/unit/services/gateway/fake_pipeline.hpp"

namespace limbcast::gateway {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

class GatewayServiceTest : public ::testing::Test {
 protected:
  test::FakeDriver& MakeService(std::size_t sensors, std::size_t ticks) {
    auto driver = std::make_unique<test::FakeDriver>(sensors, ticks);
    test::FakeDriver& fake = *driver;
    service_ = std::make_unique<GatewayService>(config_, std::move(driver), clock_, *bus_, pool_,
                                                [this] { ++ends_; });
    return fake;
  }
  void Start() { ASSERT_TRUE(service_->Start().ok()); }

  // Moves the clock on in steps of a millisecond and lets the worker do what is due.
  void Run(Duration span) {
    for (Duration at{}; at < span; at += 1ms) {
      pool_.RunDue(clock_.Now());
      clock_.Advance(1ms);
    }
    pool_.RunDue(clock_.Now());
  }

  test_support::FakeClock clock_;
  const Time start_ = clock_.Now();
  test_support::ImmediatePool pool_;
  std::unique_ptr<bus::Bus> bus_ = bus::inproc::MakeBus(bus::inproc::MakeHub());
  test::FakePipeline pipeline_{*bus_};
  GatewayConfig config_;
  int ends_ = 0;
  std::unique_ptr<GatewayService> service_;
};

TEST_F(GatewayServiceTest, RealTimePaceSendsEachTickWhenItIsDue) {
  MakeService(2, 5);
  Start();
  Run(0ms);
  EXPECT_EQ(pipeline_.samples.size(), 2U);
  Run(9ms);
  EXPECT_EQ(pipeline_.samples.size(), 2U);
  Run(1ms);
  EXPECT_EQ(pipeline_.samples.size(), 4U);
  Run(50ms);
  const auto samples = pipeline_.Of(SensorUid{2});
  ASSERT_EQ(samples.size(), 5U);
  for (std::uint32_t i = 0; i < 5; ++i) {
    EXPECT_EQ(samples[i].measured_at, start_ + i * 10ms);
    EXPECT_EQ(samples[i].published_at, start_ + i * 10ms);
    EXPECT_EQ(samples[i].sequence, i + 1);
  }
}

TEST_F(GatewayServiceTest, FasterPaceKeepsTheSpacingOfTheRecording) {
  config_.pace.speed = 5.0;
  MakeService(1, 11);
  Start();
  Run(20ms);
  ASSERT_EQ(pipeline_.samples.size(), 11U);
  EXPECT_EQ(pipeline_.samples.back().measured_at, start_ + 100ms);  // ahead of the clock
  EXPECT_EQ(pipeline_.samples.back().published_at, start_ + 20ms);
}

TEST_F(GatewayServiceTest, LoopContinuesTimeAndSequence) {
  config_.loop = true;
  MakeService(1, 3);
  Start();
  Run(75ms);
  ASSERT_EQ(pipeline_.samples.size(), 8U);
  for (std::uint32_t i = 0; i < 8; ++i) {
    EXPECT_EQ(pipeline_.samples[i].sequence, i + 1);
    EXPECT_EQ(pipeline_.samples[i].measured_at, start_ + i * 10ms);
  }
  EXPECT_EQ(service_->Summary().loops, 2U);
  EXPECT_FALSE(service_->ended());
}

TEST_F(GatewayServiceTest, EndOfDataIsToldOnceAndTheProcessEndsOnlyIfAskedTo) {
  config_.linger_s = 0.05;
  MakeService(1, 2);
  Start();
  Run(100ms);
  EXPECT_TRUE(service_->ended());
  EXPECT_EQ(service_->Summary().end, "end_of_data");
  EXPECT_EQ(ends_, 0);
  EXPECT_TRUE(service_->result().ok());

  config_.exit_at_end = true;
  MakeService(1, 2);
  Start();
  Run(40ms);
  EXPECT_EQ(ends_, 0);  // what was sent has time to arrive
  Run(60ms);
  EXPECT_EQ(ends_, 1);
}

TEST_F(GatewayServiceTest, AsFastAsPossibleWithAnAnsweringPipelineSendsAllAtOnceAndLosesNothing) {
  config_.pace.as_fast = true;
  config_.linger_s = 0.0;
  pipeline_.fusion_answers = true;
  MakeService(3, 500);
  Start();
  Run(1ms);
  EXPECT_TRUE(service_->ended());
  EXPECT_EQ(pipeline_.samples.size(), 1500U);
  const GatewaySummary summary = service_->Summary();
  EXPECT_EQ(summary.samples_unanswered, 0U);
  EXPECT_EQ(summary.ticks, 500U);
  EXPECT_NEAR(summary.stream_s, 4.99, 1e-9);
  EXPECT_EQ(pipeline_.samples.back().measured_at - pipeline_.samples.front().measured_at, 4990ms);
}

TEST_F(GatewayServiceTest, AsFastAsPossibleWaitsForTheWayToOpen) {
  config_.pace.as_fast = true;
  MakeService(1, 500);
  Start();
  Run(250ms);
  EXPECT_EQ(pipeline_.samples.size(), 0U);
  EXPECT_EQ(pipeline_.probes.size(), 3U);  // at 0, 100, 200 ms
  pipeline_.fusion_answers = true;
  Run(100ms);
  EXPECT_EQ(pipeline_.samples.size(), 500U);
}

TEST_F(GatewayServiceTest, SampleWithoutAnswerIsCountedAndHoldsNobodyUp) {
  config_.pace.as_fast = true;
  config_.window_ticks = 4;
  pipeline_.fusion_answers = true;
  pipeline_.swallow_sequence = 7;
  MakeService(1, 500);
  Start();
  Run(0ms);
  EXPECT_EQ(service_->Summary().samples_unanswered, 1U);
  EXPECT_EQ(pipeline_.samples.size(), 500U);
}

TEST_F(GatewayServiceTest, FusionThatDiesOnTheWayStopsTheStreamForOneDeadlineOnly) {
  config_.pace.as_fast = true;
  config_.window_ticks = 4;
  config_.answer_timeout_s = 0.5;
  pipeline_.fusion_answers = true;
  pipeline_.dies_after = 100;
  MakeService(1, 1000);
  Start();
  Run(490ms);
  EXPECT_EQ(pipeline_.samples.size(), 104U);  // the window bounds what is under way
  Run(110ms);                                 // then it goes on in real time
  EXPECT_NEAR(static_cast<double>(pipeline_.samples.size()), 114.0, 2.0);
  EXPECT_EQ(service_->Summary().link_losses, 1U);
  ServiceHealth health;
  service_->FillHealth(health);
  EXPECT_EQ(health.last_error, "fusion does not answer: going on in real time");

  pipeline_.dies_after = 1000;  // it is back: full speed again
  Run(20ms);
  EXPECT_EQ(pipeline_.samples.size(), 1000U);
  const GatewaySummary summary = service_->Summary();
  EXPECT_NEAR(static_cast<double>(summary.samples_unanswered), 14.0, 2.0);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    ASSERT_EQ(pipeline_.samples[i].sequence, i + 1);
  }
}

TEST_F(GatewayServiceTest, WaitTimeoutStartsAllTheSame) {
  config_.pace.as_fast = true;
  config_.wait_timeout_s = 0.1;
  MakeService(1, 1000);
  Start();
  Run(200ms);  // gives up after 100 ms, then 100 ms of data in real time
  EXPECT_NEAR(static_cast<double>(pipeline_.samples.size()), 10.0, 1.0);
  const GatewaySummary summary = service_->Summary();
  EXPECT_TRUE(summary.wait_timed_out);
  EXPECT_EQ(summary.samples_unanswered, pipeline_.samples.size());
  EXPECT_THAT(
      summary.error,
      HasSubstr("no way through the pipeline within 0.1 s (fusion: 1 of 1 sensors silent)"));
}

TEST_F(GatewayServiceTest, WaitForPostureNeedsSkeletons) {
  config_.wait_for = WaitFor::kPosture;
  pipeline_.fusion_answers = true;
  MakeService(2, 5);
  Start();
  Run(150ms);
  EXPECT_TRUE(pipeline_.samples.empty());
  ServiceHealth health;
  service_->FillHealth(health);
  EXPECT_EQ(health.last_error, "waiting: posture: 1 of 1 bodies silent");
  pipeline_.posture_answers = true;
  Run(150ms);
  EXPECT_EQ(pipeline_.samples.size(), 10U);
  EXPECT_GT(pipeline_.samples.front().measured_at, pipeline_.probes.back().measured_at);
  EXPECT_NEAR(service_->Summary().waited_s, 0.2, 0.01);
}

TEST_F(GatewayServiceTest, WaitTimeoutEndsTheServiceIfToldSo) {
  config_.wait_for = WaitFor::kFusion;
  config_.wait_timeout_s = 0.2;
  config_.exit_on_wait_timeout = true;
  MakeService(1, 5);
  Start();
  Run(300ms);
  EXPECT_TRUE(pipeline_.samples.empty());
  EXPECT_EQ(ends_, 1);
  EXPECT_EQ(service_->result().error().code, ErrorCode::kTimeout);
  EXPECT_EQ(service_->Summary().end, "failed");
}

TEST_F(GatewayServiceTest, BrokenRecordingFailsTheService) {
  test::FakeDriver& driver = MakeService(1, 5);
  driver.steps = {DriverStep::kData, Error{ErrorCode::kCorruptData, "torn tape"}};
  Start();
  Run(50ms);
  EXPECT_EQ(pipeline_.samples.size(), 1U);
  EXPECT_EQ(service_->result().error().message, "torn tape");
  EXPECT_EQ(ends_, 1);
}

TEST_F(GatewayServiceTest, BrokenDeviceIsToldInHealthAndTriedAgain) {
  auto driver = std::make_unique<test::FakeDriver>(1, 100);
  driver->description().time = DriverTime::kHost;
  driver->steps = {DriverStep::kData, Error{ErrorCode::kUnavailable, "unplugged"},
                   DriverStep::kData, DriverStep::kEnd};
  service_ = std::make_unique<GatewayService>(config_, std::move(driver), clock_, *bus_, pool_);
  Start();
  Run(500ms);
  EXPECT_EQ(pipeline_.samples.size(), 1U);
  ServiceHealth health;
  service_->FillHealth(health);
  EXPECT_EQ(health.last_error, "unplugged");
  Run(600ms);
  EXPECT_EQ(pipeline_.samples.size(), 2U);
  // Host time is passed on as the driver gave it.
  EXPECT_EQ(pipeline_.samples.back().measured_at, Time{10ms});
}

TEST_F(GatewayServiceTest, BodiesCanBeRenumbered) {
  config_.body_id = 40;
  config_.session = "evening";
  MakeService(1, 2).with_truth = true;
  Start();
  Run(20ms);
  ASSERT_EQ(pipeline_.entries.size(), 1U);
  EXPECT_EQ(pipeline_.entries[0].body_id, BodyId{40});
  EXPECT_EQ(pipeline_.entries[0].session, "evening");
  ASSERT_EQ(pipeline_.truths.size(), 2U);
  EXPECT_EQ(pipeline_.truths[1].body_id, BodyId{40});
  EXPECT_EQ(pipeline_.truths[1].measured_at, start_ + 10ms);
}

TEST_F(GatewayServiceTest, OrientationsAreNumberedMappedAndAnswered) {
  config_.pace.as_fast = true;
  pipeline_.fusion_answers = true;
  MakeService(2, 100).orientation_only = true;
  Start();
  Run(0ms);
  ASSERT_EQ(pipeline_.orientations.size(), 200U);
  EXPECT_EQ(pipeline_.orientations.back().sequence, 100U);
  EXPECT_EQ(service_->Summary().samples_unanswered, 0U);
}

TEST_F(GatewayServiceTest, StopTakesTheSensorsBackAndSaysWhatWasDone) {
  MakeService(2, 500);
  Start();
  Run(95ms);
  service_->Stop();
  service_->Stop();
  EXPECT_EQ(pipeline_.infos_disposed, 2);
  const GatewaySummary summary = service_->Summary();
  EXPECT_EQ(summary.end, "stopped");
  EXPECT_EQ(summary.published.marg, 20U);
  ASSERT_EQ(summary.by_sensor.size(), 2U);
  EXPECT_EQ(summary.by_sensor[1].label, "s1");
  EXPECT_EQ(summary.by_sensor[1].published, 10U);
}

TEST_F(GatewayServiceTest, HealthNamesItsNumbers) {
  MakeService(2, 500);
  Start();
  Run(10ms);
  ServiceHealth health;
  service_->FillHealth(health);
  EXPECT_THAT(health.values, ::testing::Contains(NamedValue{"samples.published", 4.0}));
  EXPECT_THAT(health.values, ::testing::Contains(NamedValue{"samples.mag_missing", 4.0}));
  EXPECT_EQ(health.last_error, "");
  EXPECT_EQ(health.latencies.size(), 2U);
}

TEST_F(GatewayServiceTest, LongStallJumpsInsteadOfBursting) {
  MakeService(1, 2000);
  Start();
  Run(100ms);
  clock_.Advance(5s);
  Run(100ms);
  EXPECT_EQ(service_->Summary().time_jumps, 1U);
  EXPECT_NEAR(static_cast<double>(pipeline_.samples.size()), 21.0, 2.0);
  EXPECT_EQ(pipeline_.samples.back().measured_at, pipeline_.samples.back().published_at);
}

// For the thread sanitizer: the worker streams while others ask.
TEST(GatewayServiceThreadsTest, CanBeAskedWhileItStreams) {
  const runtime::SystemClock clock;
  const auto bus = bus::inproc::MakeBus(bus::inproc::MakeHub());
  test::FakePipeline pipeline(*bus);
  pipeline.fusion_answers = true;
  runtime::ThreadPool pool("gateway", 1);
  GatewayConfig config;
  config.pace.as_fast = true;
  config.exit_at_end = true;
  config.linger_s = 0.0;
  std::promise<void> ended;
  GatewayService service(config, std::make_unique<test::FakeDriver>(15, 5000), clock, *bus, pool,
                         [&ended] { ended.set_value(); });
  ASSERT_TRUE(service.Start().ok());
  const std::future<void> end = ended.get_future();
  const auto give_up_at = std::chrono::steady_clock::now() + 60s;
  while (end.wait_for(1ms) != std::future_status::ready) {
    ServiceHealth health;
    service.FillHealth(health);
    ASSERT_LT(std::chrono::steady_clock::now(), give_up_at);
  }
  service.Stop();
  EXPECT_EQ(service.Summary().published.marg, 75'000U);
  EXPECT_EQ(service.Summary().samples_unanswered, 0U);
  EXPECT_EQ(pipeline.samples.size(), 75'000U);
}

}  // namespace
}  // namespace limbcast::gateway
