#pragma once

#include <dds/dds.h>

#include <memory>

#include "common/bus/endpoint_events.hpp"

namespace limbcast::bus::cyclone {

struct DeleteListener {
  void operator()(dds_listener_t* listener) const { dds_delete_listener(listener); }
};
using Listener = std::unique_ptr<dds_listener_t, DeleteListener>;

/// Tells `events` what happens to a writer. `events` outlives the writer.
[[nodiscard]] Listener WriterListener(EndpointEvents& events);

/// Tells `events` what happens to a reader, and calls `on_data(reader, argument)` when there is
/// data. Both outlive the reader. `exclusive`: of a topic with exclusive ownership; while it has
/// more than one writer, lost samples cannot be told from those of the weaker ones, and are not
/// told.
[[nodiscard]] Listener ReaderListener(EndpointEvents& events, bool exclusive,
                                      void (*on_data)(dds_entity_t reader, void* argument),
                                      void* argument);

}  // namespace limbcast::bus::cyclone
