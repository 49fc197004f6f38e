#include "common/bus/cyclone/cyclone_listener.hpp"

#include "common/bus/cyclone/cyclone_qos.hpp"

namespace limbcast::bus::cyclone {
namespace {

EndpointEvents& Events(void* argument) { return *static_cast<EndpointEvents*>(argument); }

void OnLost(dds_entity_t /*reader*/, const dds_sample_lost_status_t status, void* argument) {
  Events(argument).Lost(status.total_count_change);
}

// The library (0.10) also counts every sample of a writer that does not own the instance. With a
// single writer there is none.
void OnLostOfOwned(dds_entity_t reader, const dds_sample_lost_status_t status, void* argument) {
  if (Events(argument).counters().matched <= 1) {
    OnLost(reader, status, argument);
  }
}

}  // namespace

Listener WriterListener(EndpointEvents& events) {
  Listener listener(dds_create_listener(&events));
  dds_lset_publication_matched(
      listener.get(),
      [](dds_entity_t /*writer*/, const dds_publication_matched_status_t status, void* argument) {
        Events(argument).Matched(status.current_count_change,
                                 static_cast<std::int32_t>(status.current_count));
      });
  dds_lset_offered_incompatible_qos(
      listener.get(), [](dds_entity_t /*writer*/,
                         const dds_offered_incompatible_qos_status_t status, void* argument) {
        Events(argument).IncompatibleQos(status.total_count_change,
                                         PolicyName(status.last_policy_id));
      });
  return listener;
}

Listener ReaderListener(EndpointEvents& events, bool exclusive,
                        void (*on_data)(dds_entity_t reader, void* argument), void* argument) {
  Listener listener(dds_create_listener(&events));
  dds_lset_data_available_arg(listener.get(), on_data, argument, true);
  dds_lset_subscription_matched(
      listener.get(),
      [](dds_entity_t /*reader*/, const dds_subscription_matched_status_t status, void* passed) {
        Events(passed).Matched(status.current_count_change,
                               static_cast<std::int32_t>(status.current_count));
      });
  dds_lset_liveliness_changed(
      listener.get(),
      [](dds_entity_t /*reader*/, const dds_liveliness_changed_status_t status, void* passed) {
        Events(passed).Liveliness(static_cast<std::int32_t>(status.alive_count),
                                  static_cast<std::int32_t>(status.not_alive_count));
      });
  dds_lset_requested_incompatible_qos(
      listener.get(), [](dds_entity_t /*reader*/,
                         const dds_requested_incompatible_qos_status_t status, void* passed) {
        Events(passed).IncompatibleQos(status.total_count_change,
                                       PolicyName(status.last_policy_id));
      });
  dds_lset_sample_lost(listener.get(), exclusive ? &OnLostOfOwned : &OnLost);
  dds_lset_sample_rejected(
      listener.get(),
      [](dds_entity_t /*reader*/, const dds_sample_rejected_status_t status, void* passed) {
        Events(passed).Rejected(status.total_count_change, "resource limits of the reader");
      });
  return listener;
}

}  // namespace limbcast::bus::cyclone
