#include "tools/limbcast/doctor/bus_facts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/bus/inproc/inproc_bus.hpp"
#include "tests/support/fake_clock.hpp"

namespace limbcast::tool {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;

class BusFactsTest : public ::testing::Test {
 protected:
  BusFactsTest() : bus_(bus::inproc::MakeBus(bus::inproc::MakeHub(&clock_))) {
    EXPECT_TRUE(facts_.Listen(*bus_).ok());
  }
  ~BusFactsTest() override { facts_.Leave(); }
  [[nodiscard]] DoctorFacts Now() const {
    DoctorFacts now;
    facts_.Fill(now);
    return now;
  }
  template <typename T>
  void Write(const T& value) {
    EXPECT_TRUE((*bus_->MakeWriter<T>())->Write(value).ok());
  }
  test_support::FakeClock clock_;
  std::unique_ptr<bus::Bus> bus_;
  BusFacts facts_;
};

TEST_F(BusFactsTest, AProcessIsKnownByItsReportsAndTheSmallestAgeOfThem) {
  for (const Duration age : {30ms, 10ms, 20ms}) {
    ServiceHealth health;
    health.process_uid = 5;
    health.role = "fusion";
    health.reported_at = clock_.Now() - age;
    Write(health);
  }
  const DoctorFacts now = Now();
  ASSERT_EQ(now.processes.size(), 1U);
  EXPECT_EQ(now.processes.at(5).reports, 3U);
  EXPECT_EQ(now.processes.at(5).smallest_age, 10ms);
}

TEST_F(BusFactsTest, TwoSourcesInStepAreNoticed) {
  for (const std::uint32_t sequence : {0U, 0U, 1U, 1U, 2U, 2U, 3U}) {
    sensing::MargSample sample;
    sample.sensor_uid = {9};
    sample.sequence = sequence;
    Write(sample);
  }
  EXPECT_EQ(Now().sensors.at({9}).steps_back, 3U);
}

TEST_F(BusFactsTest, SensorsAreKnownByInfoSamplesAndWearers) {
  sensing::SensorInfo info;
  info.sensor_uid = {9};
  info.serial = "s9";
  Write(info);
  for (const std::uint32_t sequence : {1U, 2U, 100U, 3U, 101U, 4U}) {
    sensing::MargSample sample;
    sample.sensor_uid = {9};
    sample.sequence = sequence;
    Write(sample);
  }
  for (const std::uint32_t body : {1U, 2U}) {
    roster::RosterEntry entry;
    entry.body_id = {body};
    entry.person = body == 1 ? "Ada" : "Bob";
    entry.sensors = {{.sensor_uid = {9}, .segment = body::Segment::kPelvis}};
    Write(entry);
  }
  const DoctorFacts now = Now();
  const SensorFacts& sensor = now.sensors.at({9});
  EXPECT_EQ(sensor.serial, "s9");
  EXPECT_EQ(sensor.samples, 6U);
  EXPECT_EQ(sensor.steps_back, 2U);
  EXPECT_THAT(sensor.wearers, ElementsAre("\"Ada\" (body 1)", "\"Bob\" (body 2)"));
}

TEST_F(BusFactsTest, OnlyMismatchesOfAllEventsAreKept) {
  const auto handler = facts_.handler();
  handler({.kind = bus::BusEventKind::kMatched, .topic = "marg", .count = 1, .detail = {}});
  for (int i = 0; i < 2; ++i) {
    handler({.kind = bus::BusEventKind::kIncompatibleQos,
             .topic = "skeleton",
             .count = 1,
             .detail = "LIVELINESS"});
  }
  EXPECT_THAT(Now().mismatches,
              ElementsAre(Mismatch{bus::BusEventKind::kIncompatibleQos, "skeleton", "LIVELINESS"}));
}

}  // namespace
}  // namespace limbcast::tool
