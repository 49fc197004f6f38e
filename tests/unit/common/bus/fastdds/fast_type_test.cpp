#include "common/bus/fastdds/fast_type.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>
#include <vector>

namespace limbcast::bus::fastdds {
namespace {

using eprosima::fastrtps::rtps::InstanceHandle_t;
using eprosima::fastrtps::rtps::SerializedPayload_t;
using sensing::MargSample;
using Type = FastType<MargSample>;
using Sample = FastSample<MargSample>;

Sample SampleOf(std::uint64_t uid) {
  Sample sample;
  MargSample value;
  value.sensor_uid = {uid};
  value.sequence = 7;
  EXPECT_TRUE(Codec<MargSample>::Encode(value, sample.wire));
  return sample;
}

TEST(FastTypeTest, BytesReadBackAsTheyWereWritten) {
  Type type;
  Sample written = SampleOf(0x1122334455667788ULL);
  SerializedPayload_t payload(type.m_typeSize);
  ASSERT_TRUE(type.serialize(&written, &payload));
  EXPECT_EQ(payload.length, type.getSerializedSizeProvider(&written)());
  EXPECT_LE(payload.length, type.m_typeSize);
  Sample read;
  ASSERT_TRUE(type.deserialize(&payload, &read));
  EXPECT_FALSE(read.malformed);
  EXPECT_TRUE(read.wire == written.wire);
}

TEST(FastTypeTest, TheHandleIsTheBigEndianKey) {
  Type type;
  Sample sample = SampleOf(0x1122334455667788ULL);
  InstanceHandle_t handle;
  ASSERT_TRUE(type.getKey(&sample, &handle, false));
  const KeyHash expected = {0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88};
  EXPECT_EQ(KeyOf(handle), expected);
}

TEST(FastTypeTest, WhatDoesNotFitTheBufferIsRefused) {
  Type type;
  Sample sample = SampleOf(1);
  SerializedPayload_t payload(10);
  EXPECT_FALSE(type.serialize(&sample, &payload));
}

TEST(FastTypeTest, TruncatedBytesAreMarkedAndHaveAnInstanceOfTheirOwn) {
  Type type;
  Sample good = SampleOf(5);
  SerializedPayload_t payload(type.m_typeSize);
  ASSERT_TRUE(type.serialize(&good, &payload));
  for (std::uint32_t length = 0; length < payload.length; length += 3) {
    SerializedPayload_t cut(type.m_typeSize);
    std::copy_n(payload.data, length, cut.data);
    cut.length = length;
    Sample read = good;
    ASSERT_TRUE(type.deserialize(&cut, &read)) << "the library must not drop it silently";
    EXPECT_TRUE(read.malformed) << length;
    InstanceHandle_t handle;
    ASSERT_TRUE(type.getKey(&read, &handle, false));
    EXPECT_EQ(KeyOf(handle)[0], kMalformedHandleByte);
  }
}

TEST(FastTypeTest, KeysFromManyThreadsAreTheirOwn) {
  Type type;  // all endpoints of a participant share one
  std::atomic<int> wrong = 0;
  std::vector<std::thread> threads;
  for (std::uint64_t uid = 1; uid <= 4; ++uid) {
    threads.emplace_back([&type, &wrong, uid] {
      Sample sample = SampleOf(uid);
      for (int i = 0; i < 20'000; ++i) {
        InstanceHandle_t handle;
        type.getKey(&sample, &handle, false);
        wrong += KeyOf(handle)[7] == uid ? 0 : 1;
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace limbcast::bus::fastdds
