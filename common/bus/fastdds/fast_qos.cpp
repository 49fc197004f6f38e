#include "common/bus/fastdds/fast_qos.hpp"

#include <algorithm>
#include <array>
#include <chrono>

namespace limbcast::bus::fastdds {
namespace {

namespace dds = eprosima::fastdds::dds;
using eprosima::fastrtps::Duration_t;
using std::chrono::milliseconds;

// What a profile means in Fast DDS. One row, both directions.
struct Row {
  dds::DurabilityQosPolicyKind durability;
  dds::HistoryQosPolicyKind history;
  std::int32_t depth;                     // KEEP_LAST only
  std::int32_t max_instances;             // the library's default of 10 refuses the 11th sensor
  std::int32_t max_samples_per_instance;  // = depth for KEEP_LAST
  std::int32_t allocated_samples;         // at start; the history grows to what is in use
  Duration heartbeat_period;              // how long a lost packet or a late joiner waits at most
  dds::LivelinessQosPolicyKind liveliness;
  bool leased;  // liveliness ends after config.stream_lease; else with the participant
};

constexpr Row RowOf(QosProfile profile, const BusConfig& config) {
  switch (profile) {
    case QosProfile::kState:
      return {dds::TRANSIENT_LOCAL_DURABILITY_QOS,
              dds::KEEP_LAST_HISTORY_QOS,
              1,
              4096,
              1,
              16,
              milliseconds(100),
              dds::AUTOMATIC_LIVELINESS_QOS,
              false};
    case QosProfile::kCommand:
      return {dds::VOLATILE_DURABILITY_QOS,
              dds::KEEP_ALL_HISTORY_QOS,
              1,
              256,
              512,
              16,
              milliseconds(20),
              dds::AUTOMATIC_LIVELINESS_QOS,
              false};
    case QosProfile::kStream:
    case QosProfile::kFrame:
      break;
  }
  return {dds::VOLATILE_DURABILITY_QOS,
          dds::KEEP_LAST_HISTORY_QOS,
          config.stream_depth,
          4096,
          config.stream_depth,
          64,
          milliseconds(20),
          dds::MANUAL_BY_TOPIC_LIVELINESS_QOS,
          true};
}

Duration_t ToFast(Duration duration) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  return {static_cast<std::int32_t>(duration.count() / kSecond_ns),
          static_cast<std::uint32_t>(duration.count() % kSecond_ns)};
}

// A reader must not ask for less than a writer of the same configuration offers, and the vendors
// round differently on the wire (2^-32 s).
constexpr Duration kLeaseTolerance = milliseconds(1);

// The policies that writers and readers share.
template <typename Qos>
Qos CommonQos(const Row& row, bool exclusive, const BusConfig& config) {
  Qos qos;
  qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
  qos.reliability().max_blocking_time = ToFast(milliseconds(100));
  qos.durability().kind = row.durability;
  qos.history().kind = row.history;
  qos.history().depth = row.depth;
  qos.resource_limits().max_instances = row.max_instances;
  qos.resource_limits().max_samples_per_instance = row.max_samples_per_instance;
  qos.resource_limits().max_samples = row.max_instances * row.max_samples_per_instance;
  qos.resource_limits().allocated_samples = row.allocated_samples;
  qos.liveliness().kind = row.liveliness;
  if (row.leased) {
    qos.liveliness().lease_duration = ToFast(config.stream_lease);
    qos.liveliness().announcement_period = ToFast(config.stream_lease / 3);
  }
  qos.ownership().kind = exclusive ? dds::EXCLUSIVE_OWNERSHIP_QOS : dds::SHARED_OWNERSHIP_QOS;
  qos.endpoint().history_memory_policy =
      eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  qos.data_sharing().off();
  return qos;
}

}  // namespace

dds::DataWriterQos WriterQos(QosProfile profile, bool exclusive, const BusConfig& config) {
  Row row = RowOf(profile, config);
  if (profile == QosProfile::kFrame) {
    row.depth = row.max_samples_per_instance = FrameDepth(row.depth);
  }
  auto qos = CommonQos<dds::DataWriterQos>(row, exclusive, config);
  if (exclusive) {
    qos.ownership_strength().value = static_cast<std::uint32_t>(config.ownership_strength);
  }
  qos.publish_mode().kind = dds::SYNCHRONOUS_PUBLISH_MODE;
  // FastWriter unregisters from an instance to dispose of it. Leaving does not: values of state
  // topics stay until somebody disposes of them.
  qos.writer_data_lifecycle().autodispose_unregistered_instances = true;
  auto& times = qos.reliable_writer_qos().times;
  times.heartbeatPeriod = ToFast(row.heartbeat_period);
  times.initialHeartbeatDelay = ToFast(milliseconds(2));
  times.nackResponseDelay = ToFast(milliseconds(1));
  return qos;
}

dds::DataReaderQos ReaderQos(QosProfile profile, bool exclusive, const BusConfig& config) {
  Row row = RowOf(profile, config);
  if (profile == QosProfile::kState) {
    row.depth = row.max_samples_per_instance = kStateReaderDepth;
  }
  auto qos = CommonQos<dds::DataReaderQos>(row, exclusive, config);
  if (row.leased) {
    qos.liveliness().lease_duration = ToFast(config.stream_lease + kLeaseTolerance);
  }
  auto& times = qos.reliable_reader_qos().times;
  times.initialAcknackDelay = ToFast(milliseconds(5));
  times.heartbeatResponseDelay = ToFast(milliseconds(1));
  return qos;
}

std::string_view PolicyName(std::uint32_t policy_id) {
  constexpr std::array<std::string_view, 25> kNames = {"invalid",
                                                       "user_data",
                                                       "durability",
                                                       "presentation",
                                                       "deadline",
                                                       "latency_budget",
                                                       "ownership",
                                                       "ownership_strength",
                                                       "liveliness",
                                                       "time_based_filter",
                                                       "partition",
                                                       "reliability",
                                                       "destination_order",
                                                       "history",
                                                       "resource_limits",
                                                       "entity_factory",
                                                       "writer_data_lifecycle",
                                                       "reader_data_lifecycle",
                                                       "topic_data",
                                                       "group_data",
                                                       "transport_priority",
                                                       "lifespan",
                                                       "durability_service",
                                                       "data_representation",
                                                       "type_consistency"};
  return policy_id < kNames.size() ? kNames[policy_id] : "unknown";
}

}  // namespace limbcast::bus::fastdds
