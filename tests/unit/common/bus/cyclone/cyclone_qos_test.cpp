#include "common/bus/cyclone/cyclone_qos.hpp"

#include <gtest/gtest.h>

namespace limbcast::bus::cyclone {
namespace {

struct Read {
  explicit Read(const Qos& qos) {
    EXPECT_TRUE(dds_qget_reliability(qos.get(), &reliability, &max_blocking));
    EXPECT_TRUE(dds_qget_durability(qos.get(), &durability));
    EXPECT_TRUE(dds_qget_history(qos.get(), &history, &depth));
    EXPECT_TRUE(dds_qget_resource_limits(qos.get(), &max_samples, &max_instances, &per_instance));
    EXPECT_TRUE(dds_qget_liveliness(qos.get(), &liveliness, &lease));
    EXPECT_TRUE(dds_qget_ownership(qos.get(), &ownership));
  }
  dds_reliability_kind_t reliability{};
  dds_duration_t max_blocking = 0;
  dds_durability_kind_t durability{};
  dds_history_kind_t history{};
  std::int32_t depth = 0;
  std::int32_t max_samples = 0;
  std::int32_t max_instances = 0;
  std::int32_t per_instance = 0;
  dds_liveliness_kind_t liveliness{};
  dds_duration_t lease = 0;
  dds_ownership_kind_t ownership{};
};

TEST(CycloneQosTest, AStreamKeepsTheLastFewAndProvesThatItPublishes) {
  const BusConfig config{.stream_lease = std::chrono::milliseconds(250), .stream_depth = 7};
  const Read qos(WriterQos(QosProfile::kStream, false, config));
  EXPECT_EQ(qos.reliability, DDS_RELIABILITY_RELIABLE);
  EXPECT_EQ(qos.durability, DDS_DURABILITY_VOLATILE);
  EXPECT_EQ(qos.history, DDS_HISTORY_KEEP_LAST);
  EXPECT_EQ(qos.depth, 7);
  EXPECT_EQ(qos.liveliness, DDS_LIVELINESS_MANUAL_BY_TOPIC);
  EXPECT_EQ(qos.lease, DDS_MSECS(250));
  EXPECT_EQ(qos.ownership, DDS_OWNERSHIP_SHARED);
}

TEST(CycloneQosTest, AWriterKeepsHalfAsManyFramesAsOtherSamplesAndAReaderAsMany) {
  const BusConfig config{.stream_depth = 16};
  EXPECT_EQ(Read(WriterQos(QosProfile::kFrame, false, config)).depth, 8);
  EXPECT_EQ(Read(ReaderQos(QosProfile::kFrame, false, config)).depth, 16);
  EXPECT_EQ(Read(WriterQos(QosProfile::kFrame, false, {.stream_depth = 1})).depth, 1);
  EXPECT_EQ(Read(WriterQos(QosProfile::kFrame, false, config)).liveliness,
            DDS_LIVELINESS_MANUAL_BY_TOPIC);
}

TEST(CycloneQosTest, AStateIsKeptForLateJoiners) {
  const Read qos(WriterQos(QosProfile::kState, false, {}));
  EXPECT_EQ(qos.reliability, DDS_RELIABILITY_RELIABLE);
  EXPECT_EQ(qos.durability, DDS_DURABILITY_TRANSIENT_LOCAL);
  EXPECT_EQ(qos.history, DDS_HISTORY_KEEP_LAST);
  EXPECT_EQ(qos.depth, 1);
  EXPECT_EQ(qos.liveliness, DDS_LIVELINESS_AUTOMATIC);
}

TEST(CycloneQosTest, AReaderOfStatesKeepsThoseOfSeveralWriters) {
  EXPECT_EQ(Read(ReaderQos(QosProfile::kState, false, {})).depth, kStateReaderDepth);
}

TEST(CycloneQosTest, CommandsAreAllKeptWithinLimitsAndBlockAtMost100Milliseconds) {
  const Read qos(WriterQos(QosProfile::kCommand, false, {}));
  EXPECT_EQ(qos.history, DDS_HISTORY_KEEP_ALL);
  EXPECT_EQ(qos.max_instances, 256);
  EXPECT_EQ(qos.per_instance, 512);
  EXPECT_EQ(qos.max_samples, 256 * 512);
  EXPECT_EQ(qos.max_blocking, DDS_MSECS(100));
}

TEST(CycloneQosTest, ExclusiveOwnershipHasTheStrengthOfTheConfiguration) {
  const Qos qos = WriterQos(QosProfile::kStream, true, {.ownership_strength = 33});
  EXPECT_EQ(Read(qos).ownership, DDS_OWNERSHIP_EXCLUSIVE);
  std::int32_t strength = 0;
  ASSERT_TRUE(dds_qget_ownership_strength(qos.get(), &strength));
  EXPECT_EQ(strength, 33);
}

TEST(CycloneQosTest, ThePartitionIsThatOfTheConfigurationAndNoneMeansTheDefault) {
  std::uint32_t count = 0;
  char** names = nullptr;
  ASSERT_TRUE(dds_qget_partition(GroupQos({.partition = "hall"}).get(), &count, &names));
  ASSERT_EQ(count, 1U);
  EXPECT_STREQ(names[0], "hall");
  dds_free(names[0]);
  dds_free(static_cast<void*>(names));
  EXPECT_FALSE(dds_qget_partition(GroupQos({}).get(), &count, &names));
}

TEST(CycloneQosTest, PoliciesAreNamedByTheirNumbers) {
  EXPECT_EQ(PolicyName(DDS_LIVELINESS_QOS_POLICY_ID), "liveliness");
  EXPECT_EQ(PolicyName(DDS_OWNERSHIP_QOS_POLICY_ID), "ownership");
  EXPECT_EQ(PolicyName(DDS_RELIABILITY_QOS_POLICY_ID), "reliability");
  EXPECT_EQ(PolicyName(DDS_DATA_REPRESENTATION_QOS_POLICY_ID), "data_representation");
  EXPECT_EQ(PolicyName(1000), "unknown");
}

}  // namespace
}  // namespace limbcast::bus::cyclone
