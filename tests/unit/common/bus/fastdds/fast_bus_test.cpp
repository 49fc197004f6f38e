#include "common/bus/fastdds/fast_bus.hpp"

#include <gtest/gtest.h>

#include "tests/unit/common/bus/test_domain.hpp"

namespace limbcast::bus::fastdds {
namespace {

using roster::RosterEntry;
using sensing::MargSample;
using testing::Collected;
using testing::CollectedEvents;
using testing::LoopbackConfig;

template <typename T>
ReaderHandler<T> Into(Collected<T>& collected) {
  return {.on_sample = [&](const T& value, const SampleInfo&) { collected.Add(value); }};
}

TEST(FastBusTest, OneBusHearsItself) {
  const auto bus = OpenFast(LoopbackConfig(Vendor::kFast), {});
  ASSERT_TRUE(bus) << bus.error().message;
  Collected<MargSample> heard;
  const auto reader = (*bus)->MakeReader<MargSample>(Into(heard));
  const auto writer = (*bus)->MakeWriter<MargSample>();
  ASSERT_TRUE((*writer)->Write({.sequence = 3}));
  ASSERT_TRUE(heard.WaitForCount(1));
  EXPECT_EQ(heard.items()[0].sequence, 3U);
}

TEST(FastBusTest, ALateJoinerGetsTheLastStateOfEachInstance) {
  const auto speaking = OpenFast(LoopbackConfig(Vendor::kFast), {});
  const auto listening = OpenFast(LoopbackConfig(Vendor::kFast), {});
  ASSERT_TRUE(speaking && listening);
  const auto writer = (*speaking)->MakeWriter<RosterEntry>();
  for (std::uint32_t revision = 1; revision <= 3; ++revision) {
    for (std::uint32_t body = 1; body <= 5; ++body) {
      ASSERT_TRUE((*writer)->Write({.body_id = {body}, .revision = revision}));
    }
  }
  Collected<RosterEntry> heard;
  const auto reader = (*listening)->MakeReader<RosterEntry>(Into(heard));
  ASSERT_TRUE(heard.WaitForCount(5));
  const auto entries = heard.items();
  EXPECT_EQ(entries.size(), 5U);
  for (const RosterEntry& entry : entries) {
    EXPECT_EQ(entry.revision, 3U);
  }
}

TEST(FastBusTest, PartitionsOfOneProcessAreSeparate) {
  BusConfig config = LoopbackConfig(Vendor::kFast);
  CollectedEvents events;
  config.partition = "hall";
  const auto hall = OpenFast(config, events.handler());
  config.partition = "studio";
  const auto studio = OpenFast(config, {});
  config.partition = "*";
  const auto monitor = OpenFast(config, {});
  ASSERT_TRUE(hall && studio && monitor);
  Collected<RosterEntry> in_studio;
  Collected<RosterEntry> in_monitor;
  const auto studio_reader = (*studio)->MakeReader<RosterEntry>(Into(in_studio));
  const auto monitor_reader = (*monitor)->MakeReader<RosterEntry>(Into(in_monitor));
  const auto hall_writer = (*hall)->MakeWriter<RosterEntry>();
  const auto studio_writer = (*studio)->MakeWriter<RosterEntry>();
  ASSERT_TRUE((*hall_writer)->Write({.body_id = {1}}));
  ASSERT_TRUE((*studio_writer)->Write({.body_id = {2}}));
  ASSERT_TRUE(in_monitor.WaitForCount(2));
  ASSERT_TRUE(in_studio.WaitForCount(1));
  EXPECT_EQ(in_studio.items()[0].body_id.value, 2U);
  EXPECT_EQ((*hall_writer)->counters().matched, 1);  // the monitor only
}

TEST(FastBusTest, WhatDoesNotFitTheWireIsRefusedAndNotSent) {
  const auto bus = OpenFast(LoopbackConfig(Vendor::kFast), {});
  ASSERT_TRUE(bus);
  const auto writer = (*bus)->MakeWriter<RosterEntry>();
  const Status refused = (*writer)->Write({.person = std::string(65, 'p')});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(refused.error().message, "roster.person has 65 characters, at most 64 are allowed");
  EXPECT_EQ((*writer)->counters().samples, 0U);
}

}  // namespace
}  // namespace limbcast::bus::fastdds
