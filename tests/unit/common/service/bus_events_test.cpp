#include "common/service/bus_events.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <sstream>
#include <thread>
#include <vector>

namespace limbcast::service {
namespace {

using bus::BusEvent;
using bus::BusEventKind;
using ::testing::HasSubstr;

BusEvent OnMarg(BusEventKind kind, std::int64_t count) {
  BusEvent event;
  event.kind = kind;
  event.topic = "marg";
  event.count = count;
  return event;
}

class BusEventsTest : public ::testing::Test {
 protected:
  BusEventsTest() : previous_(spdlog::default_logger()) {
    auto logger = std::make_shared<spdlog::logger>(
        "test", std::make_shared<spdlog::sinks::ostream_sink_mt>(log_));
    logger->set_pattern("%l %v");
    spdlog::set_default_logger(std::move(logger));
  }
  ~BusEventsTest() override { spdlog::set_default_logger(previous_); }
  double Value(const std::string& name) {
    health_ = {};
    events_.Report(health_);
    for (const NamedValue& value : health_.values) {
      if (value.name == name) {
        return value.value;
      }
    }
    ADD_FAILURE() << "no value " << name;
    return -1.0;
  }
  std::ostringstream log_;
  BusEvents events_;
  ServiceHealth health_;

 private:
  std::shared_ptr<spdlog::logger> previous_;
};

TEST_F(BusEventsTest, CountsEventsByKindAndLostSamplesByTheirNumber) {
  const bus::BusEventHandler handler = events_.handler();
  handler(OnMarg(BusEventKind::kMatched, 3));
  handler(OnMarg(BusEventKind::kSampleLost, 7));
  handler(OnMarg(BusEventKind::kSampleLost, 2));
  EXPECT_EQ(events_.count(BusEventKind::kMatched), 1U);
  EXPECT_EQ(Value("bus.matched"), 1.0);
  EXPECT_EQ(Value("bus.sample_lost"), 9.0);
  EXPECT_EQ(Value("bus.malformed"), 0.0);
}

TEST_F(BusEventsTest, LogsOneNamedLineForAnEventAndOnlyWhenAsked) {
  events_.Note({.kind = BusEventKind::kIncompatibleQos,
                .topic = "skeleton",
                .from_writer = true,
                .count = 1,
                .detail = "OWNERSHIP"});
  EXPECT_EQ(log_.str(), "") << "a middleware thread must not wait for the log";
  events_.Report(health_);
  EXPECT_EQ(log_.str(), "warning bus: incompatible_qos on skeleton (writer, count 1): OWNERSHIP\n");
  events_.Report(health_);
  EXPECT_EQ(log_.str().find('\n'), log_.str().size() - 1) << "once";
  EXPECT_THAT(health_.last_error, HasSubstr("incompatible_qos on skeleton"));
}

TEST_F(BusEventsTest, ALostWriterIsTheLastErrorUntilOneIsBack) {
  events_.Note(OnMarg(BusEventKind::kLivelinessLost, 0));
  events_.Report(health_);
  EXPECT_EQ(health_.last_error, "bus: liveliness_lost on marg (reader, now 0)");
  events_.Note(OnMarg(BusEventKind::kLivelinessGained, 1));
  health_ = {};
  events_.Report(health_);
  EXPECT_EQ(health_.last_error, "");
}

TEST_F(BusEventsTest, AnErrorOfTheServiceItselfGoesFirst) {
  events_.Note(OnMarg(BusEventKind::kLivelinessLost, 0));
  health_.last_error = "no device";
  events_.Report(health_);
  EXPECT_EQ(health_.last_error, "no device");
}

TEST_F(BusEventsTest, AFloodIsCountedInFullAndLoggedInPart) {
  std::vector<std::thread> threads;
  for (int t = 0; t < 2; ++t) {
    threads.emplace_back([this] {
      for (int i = 0; i < 500; ++i) {
        events_.Note(OnMarg(BusEventKind::kMalformed, 1));
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(Value("bus.malformed"), 1000.0);
  const std::string text = log_.str();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 65);
  EXPECT_THAT(text, HasSubstr("936 more events within one second"));
}

}  // namespace
}  // namespace limbcast::service
