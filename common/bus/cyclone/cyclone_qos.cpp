#include "common/bus/cyclone/cyclone_qos.hpp"

#include <array>
#include <chrono>

namespace limbcast::bus::cyclone {
namespace {

// What a profile means in Cyclone DDS. One row, both directions.
struct Row {
  dds_durability_kind_t durability;
  dds_history_kind_t history;
  std::int32_t depth;                     // KEEP_LAST only
  std::int32_t max_instances;             // KEEP_ALL only, so that nothing grows without limit
  std::int32_t max_samples_per_instance;  // KEEP_ALL only
  dds_liveliness_kind_t liveliness;
  dds_duration_t lease;
};

Row RowOf(QosProfile profile, const BusConfig& config) {
  switch (profile) {
    case QosProfile::kState:
      return {DDS_DURABILITY_TRANSIENT_LOCAL,
              DDS_HISTORY_KEEP_LAST,
              1,
              DDS_LENGTH_UNLIMITED,
              DDS_LENGTH_UNLIMITED,
              DDS_LIVELINESS_AUTOMATIC,
              DDS_INFINITY};
    case QosProfile::kCommand:
      return {DDS_DURABILITY_VOLATILE,  DDS_HISTORY_KEEP_ALL, 1, 256, 512,
              DDS_LIVELINESS_AUTOMATIC, DDS_INFINITY};
    case QosProfile::kStream:
    case QosProfile::kFrame:
      break;
  }
  return {DDS_DURABILITY_VOLATILE,    DDS_HISTORY_KEEP_LAST, config.stream_depth,
          DDS_LENGTH_UNLIMITED,       DDS_LENGTH_UNLIMITED,  DDS_LIVELINESS_MANUAL_BY_TOPIC,
          config.stream_lease.count()};
}

constexpr dds_duration_t kMaxBlocking = DDS_MSECS(100);

Qos EndpointQos(const Row& row, bool exclusive, const BusConfig& config) {
  Qos qos(dds_create_qos());
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, kMaxBlocking);
  dds_qset_durability(qos.get(), row.durability);
  dds_qset_history(qos.get(), row.history, row.depth);
  const std::int32_t max_samples = row.history == DDS_HISTORY_KEEP_ALL
                                       ? row.max_instances * row.max_samples_per_instance
                                       : DDS_LENGTH_UNLIMITED;
  dds_qset_resource_limits(qos.get(), max_samples, row.max_instances, row.max_samples_per_instance);
  dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, 1, DDS_LENGTH_UNLIMITED,
                              DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  dds_qset_liveliness(qos.get(), row.liveliness, row.lease);
  dds_qset_ownership(qos.get(), exclusive ? DDS_OWNERSHIP_EXCLUSIVE : DDS_OWNERSHIP_SHARED);
  if (exclusive) {
    dds_qset_ownership_strength(qos.get(), config.ownership_strength);
  }
  // Leaving must not dispose: values of state topics stay until somebody disposes them.
  dds_qset_writer_data_lifecycle(qos.get(), false);
  dds_qset_destination_order(qos.get(), DDS_DESTINATIONORDER_BY_RECEPTION_TIMESTAMP);
  dds_qset_deadline(qos.get(), DDS_INFINITY);
  dds_qset_lifespan(qos.get(), DDS_INFINITY);
  dds_qset_latency_budget(qos.get(), 0);
  const dds_data_representation_id_t representation = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos.get(), 1, &representation);
  return qos;
}

}  // namespace

Qos WriterQos(QosProfile profile, bool exclusive, const BusConfig& config) {
  Row row = RowOf(profile, config);
  if (profile == QosProfile::kFrame) {
    row.depth = FrameDepth(row.depth);
  }
  return EndpointQos(row, exclusive, config);
}

Qos ReaderQos(QosProfile profile, bool exclusive, const BusConfig& config) {
  Row row = RowOf(profile, config);
  if (profile == QosProfile::kState) {
    row.depth = kStateReaderDepth;
  }
  return EndpointQos(row, exclusive, config);
}

Qos GroupQos(const BusConfig& config) {
  Qos qos(dds_create_qos());
  if (!config.partition.empty()) {
    dds_qset_partition1(qos.get(), config.partition.c_str());
  }
  return qos;
}

std::string_view PolicyName(std::uint32_t policy_id) {
  constexpr std::array<std::string_view, 26> kNames = {"invalid",
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
                                                       "property",
                                                       "type_consistency",
                                                       "data_representation"};
  return policy_id < kNames.size() ? kNames[policy_id] : "unknown";
}

}  // namespace limbcast::bus::cyclone
