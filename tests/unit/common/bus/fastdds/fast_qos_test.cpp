#include "common/bus/fastdds/fast_qos.hpp"

#include <gtest/gtest.h>

namespace limbcast::bus::fastdds {
namespace {

namespace dds = eprosima::fastdds::dds;
using std::chrono::milliseconds;

TEST(FastQosTest, AStreamKeepsTheLastFewAndProvesThatItPublishes) {
  BusConfig config;
  config.stream_lease = milliseconds(250);
  config.stream_depth = 7;
  const auto qos = WriterQos(QosProfile::kStream, false, config);
  EXPECT_EQ(qos.reliability().kind, dds::RELIABLE_RELIABILITY_QOS);
  EXPECT_EQ(qos.durability().kind, dds::VOLATILE_DURABILITY_QOS);
  EXPECT_EQ(qos.history().kind, dds::KEEP_LAST_HISTORY_QOS);
  EXPECT_EQ(qos.history().depth, 7);
  EXPECT_EQ(qos.liveliness().kind, dds::MANUAL_BY_TOPIC_LIVELINESS_QOS);
  EXPECT_EQ(qos.liveliness().lease_duration.to_ns(), 250'000'000);
  EXPECT_EQ(qos.ownership().kind, dds::SHARED_OWNERSHIP_QOS);
  EXPECT_EQ(qos.publish_mode().kind, dds::SYNCHRONOUS_PUBLISH_MODE);
}

TEST(FastQosTest, AWriterKeepsHalfAsManyFramesAsOtherSamplesAndAReaderAsMany) {
  BusConfig config;
  config.stream_depth = 16;
  EXPECT_EQ(WriterQos(QosProfile::kFrame, false, config).history().depth, 8);
  EXPECT_EQ(ReaderQos(QosProfile::kFrame, false, config).history().depth, 16);
  config.stream_depth = 1;
  EXPECT_EQ(WriterQos(QosProfile::kFrame, false, config).history().depth, 1);
}

TEST(FastQosTest, AStateIsKeptForLateJoinersWhoHearOfItWithinATenthOfASecond) {
  const auto qos = WriterQos(QosProfile::kState, false, {});
  EXPECT_EQ(qos.durability().kind, dds::TRANSIENT_LOCAL_DURABILITY_QOS);
  EXPECT_EQ(qos.history().depth, 1);
  EXPECT_LE(qos.reliable_writer_qos().times.heartbeatPeriod.to_ns(), 100'000'000);
  EXPECT_TRUE(
      qos.writer_data_lifecycle().autodispose_unregistered_instances);  // when somebody disposes
}

TEST(FastQosTest, AReaderOfStatesKeepsThoseOfSeveralWriters) {
  EXPECT_EQ(ReaderQos(QosProfile::kState, false, {}).history().depth, kStateReaderDepth);
}

TEST(FastQosTest, CommandsAreAllKeptWithinLimitsAndBlockAtMost100Milliseconds) {
  const auto qos = WriterQos(QosProfile::kCommand, false, {});
  EXPECT_EQ(qos.history().kind, dds::KEEP_ALL_HISTORY_QOS);
  EXPECT_EQ(qos.resource_limits().max_instances, 256);
  EXPECT_EQ(qos.resource_limits().max_samples_per_instance, 512);
  EXPECT_EQ(qos.reliability().max_blocking_time.to_ns(), 100'000'000);
}

TEST(FastQosTest, LimitsAgreeWithEachOtherForEveryProfileAndDepth) {
  // The library makes no endpoint otherwise.
  for (const QosProfile profile :
       {QosProfile::kStream, QosProfile::kFrame, QosProfile::kState, QosProfile::kCommand}) {
    for (const std::int32_t depth : {1, 16, 1024}) {
      BusConfig config;
      config.stream_depth = depth;
      const auto reader = ReaderQos(profile, false, config);
      const auto writer = WriterQos(profile, false, config);
      for (const auto& limits : {reader.resource_limits(), writer.resource_limits()}) {
        EXPECT_GE(limits.max_instances, 64);
        EXPECT_EQ(limits.max_samples, limits.max_instances * limits.max_samples_per_instance);
        EXPECT_LE(limits.allocated_samples, limits.max_samples);
      }
      EXPECT_GE(writer.resource_limits().max_samples_per_instance, writer.history().depth);
    }
  }
}

TEST(FastQosTest, AReaderNeverAsksForLessThanAnEqualWriterOffers) {
  for (const int lease_ms : {50, 333, 60'000}) {
    BusConfig config;
    config.stream_lease = milliseconds(lease_ms);
    EXPECT_GT(ReaderQos(QosProfile::kStream, false, config).liveliness().lease_duration,
              WriterQos(QosProfile::kStream, false, config).liveliness().lease_duration);
  }
}

TEST(FastQosTest, ExclusiveOwnershipHasTheStrengthOfTheConfiguration) {
  BusConfig config;
  config.ownership_strength = 33;
  const auto writer = WriterQos(QosProfile::kStream, true, config);
  EXPECT_EQ(writer.ownership().kind, dds::EXCLUSIVE_OWNERSHIP_QOS);
  EXPECT_EQ(writer.ownership_strength().value, 33U);
  EXPECT_EQ(ReaderQos(QosProfile::kStream, true, config).ownership().kind,
            dds::EXCLUSIVE_OWNERSHIP_QOS);
}

TEST(FastQosTest, NothingSharesMemory) {
  EXPECT_EQ(WriterQos(QosProfile::kStream, false, {}).data_sharing().kind(), dds::OFF);
  EXPECT_EQ(ReaderQos(QosProfile::kStream, false, {}).data_sharing().kind(), dds::OFF);
}

TEST(FastQosTest, PoliciesHaveTheirNames) {
  EXPECT_EQ(PolicyName(dds::LIVELINESS_QOS_POLICY_ID), "liveliness");
  EXPECT_EQ(PolicyName(dds::OWNERSHIP_QOS_POLICY_ID), "ownership");
  EXPECT_EQ(PolicyName(dds::RELIABILITY_QOS_POLICY_ID), "reliability");
  EXPECT_EQ(PolicyName(9999), "unknown");
}

}  // namespace
}  // namespace limbcast::bus::fastdds
