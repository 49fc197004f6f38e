#include "common/service/health_publisher.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <future>
#include <vector>

#include "common/bus/inproc/inproc_bus.hpp"
#include "tests/support/fake_clock.hpp"

namespace limbcast::service {
namespace {

using namespace std::chrono_literals;

class HealthPublisherTest : public ::testing::Test {
 protected:
  HealthPublisherTest()
      : bus_(bus::inproc::MakeBus(bus::inproc::MakeHub(&clock_))),
        reader_(*bus_->MakeReader<ServiceHealth>(
            {.on_sample =
                 [this](const ServiceHealth& health, const bus::SampleInfo&) {
                   heard_.push_back(health);
                   if (heard_.size() == 2) {
                     second_.set_value();
                   }
                 },
             .on_disposed = {}})) {}
  std::unique_ptr<HealthPublisher> Make(HealthPublisher::Fill fill) {
    auto made = HealthPublisher::Make("fusion", clock_, *bus_, std::move(fill));
    EXPECT_TRUE(made.ok());
    return std::move(*made);
  }
  test_support::FakeClock clock_;
  std::promise<void> second_;
  std::vector<ServiceHealth> heard_;  // written on the publishing thread; read when that rests
  std::unique_ptr<bus::Bus> bus_;
  std::unique_ptr<bus::Reader<ServiceHealth>> reader_;
};

TEST_F(HealthPublisherTest, SaysWhoAndHowMuchAndWhatTheServiceAdds) {
  const Time started_at = clock_.Now();
  const auto publisher = Make([](ServiceHealth& health) {
    health.values.push_back({"samples.received", 3.0});
    health.latencies.push_back({.stage = "x", .count = 1});
  });
  clock_.Advance(5s);
  publisher->Publish();
  ASSERT_EQ(heard_.size(), 1U);
  const ServiceHealth& health = heard_[0];
  EXPECT_NE(health.process_uid, 0U);
  EXPECT_EQ(health.role, "fusion");
  EXPECT_FALSE(health.host.empty());
  EXPECT_EQ(health.pid, static_cast<std::uint32_t>(getpid()));
  EXPECT_EQ(health.started_at, started_at);
  EXPECT_EQ(health.reported_at, started_at + 5s);
  EXPECT_GT(health.rss_mib, 0.0);
  ASSERT_EQ(health.values.size(), 2U);
  EXPECT_EQ(health.values[0].name, "gauge.threads");
  EXPECT_EQ(health.values[1], (NamedValue{"samples.received", 3.0}));
  EXPECT_EQ(health.latencies.size(), 1U);
  publisher->Publish();
  EXPECT_EQ(heard_[1].values.size(), 2U) << "each report starts empty";
}

TEST_F(HealthPublisherTest, TheLastErrorIsKeptUntilItIsTakenBackAndCutToItsBound) {
  const auto publisher = Make([](ServiceHealth&) {});
  publisher->SetLastError(std::string(400, 'x'));
  publisher->Publish();
  ASSERT_EQ(heard_.size(), 1U) << "too long for the wire";
  EXPECT_EQ(heard_[0].last_error, std::string(255, 'x'));
  publisher->SetLastError("");
  publisher->Publish();
  EXPECT_EQ(heard_[1].last_error, "");
}

TEST_F(HealthPublisherTest, TwoPublishersAreTwoProcesses) {
  const auto a = Make([](ServiceHealth&) {});
  const auto b = Make([](ServiceHealth&) {});
  a->Publish();
  b->Publish();
  EXPECT_NE(heard_[0].process_uid, heard_[1].process_uid);
}

TEST_F(HealthPublisherTest, PublishesByItselfAndALastTimeAtTheEnd) {
  std::atomic<int> fills{0};
  const auto publisher = Make([&](ServiceHealth&) { ++fills; });
  publisher->Start(1ms);
  second_.get_future().wait();
  publisher->Stop();
  const std::size_t at_stop = heard_.size();
  EXPECT_GE(at_stop, 3U);
  EXPECT_EQ(static_cast<int>(at_stop), fills);
  publisher->Stop();
  EXPECT_EQ(heard_.size(), at_stop);
}

}  // namespace
}  // namespace limbcast::service
