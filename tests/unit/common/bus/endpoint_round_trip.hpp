#pragma once

// Every topic crosses two buses of one DDS vendor, field by field; the
// <vendor>_endpoints_*_test.cpp instantiate it.

#include <gtest/gtest.h>

#include <random>

#include "common/bus/bus_factory.hpp"
#include "tests/unit/common/bus/random_values.hpp"
#include "tests/unit/common/bus/test_domain.hpp"

namespace limbcast::bus::testing {

/// Written by one bus, the value arrives at the other unchanged, and so does its dispose.
template <typename T>
void ExpectCrossing(Vendor vendor) {
  CollectedEvents sending_events;
  CollectedEvents receiving_events;
  const auto sending = Open(LoopbackConfig(vendor), sending_events.handler());
  ASSERT_TRUE(sending) << sending.error().message;
  const auto receiving = Open(LoopbackConfig(vendor), receiving_events.handler());
  ASSERT_TRUE(receiving) << receiving.error().message;

  Collected<T> samples;
  Collected<T> disposed;
  const auto reader =
      (*receiving)
          ->template MakeReader<T>(
              {.on_sample = [&](const T& value, const SampleInfo&) { samples.Add(value); },
               .on_disposed = [&](const T& key) { disposed.Add(key); }});
  ASSERT_TRUE(reader) << reader.error().message;
  const auto writer = (*sending)->template MakeWriter<T>();
  ASSERT_TRUE(writer) << writer.error().message;

  std::mt19937_64 rng(20240517);
  const T value = RandomValue<T>(rng);
  ASSERT_TRUE(sending_events.WaitForEvent(BusEventKind::kMatched, /*from_writer=*/true));
  ASSERT_TRUE(receiving_events.WaitForEvent(BusEventKind::kMatched, /*from_writer=*/false));
  ASSERT_TRUE((*writer)->Write(value));
  (*writer)->Flush();
  ASSERT_TRUE(samples.WaitForCount(1));
  EXPECT_TRUE(Equal(samples.items().front(), value));
  ASSERT_TRUE((*writer)->Dispose(value));
  ASSERT_TRUE(disposed.WaitForCount(1));
  EXPECT_GE((*reader)->counters().samples, 1U);
  EXPECT_EQ((*reader)->counters().disposed, 1U);
  EXPECT_EQ((*reader)->counters().malformed, 0U);
}

}  // namespace limbcast::bus::testing
