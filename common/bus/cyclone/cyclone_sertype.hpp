#pragma once

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>

#include <functional>
#include <memory>
#include <span>

#include "common/bus/cyclone/wire_ops.hpp"

namespace limbcast::bus::cyclone {

/// Called (on a receiving thread) with the reason when bytes came that are not even keyed like the
/// type.
using MalformedHandler = std::function<void(const char* why)>;

/// Makes Cyclone DDS carry a type as Fast CDR serialises it: the library sees opaque bytes and a
/// key. Samples for dds_write are the wire type of `ops`; read with dds_takecdr and Payload.
/// The caller gives it to dds_create_topic_sertype or unrefs it.
[[nodiscard]] ddsi_sertype* MakeSertype(const WireOps& ops, MalformedHandler on_malformed);

/// The encapsulated CDR of a sample of such a type; valid while the sample is referenced.
[[nodiscard]] std::span<const char> Payload(const ddsi_serdata* data);

/// What tells readers that the writer disposes of the instance with the key of `wire` and
/// unregisters from it, in one message: for dds_forwardcdr, which takes it over.
[[nodiscard]] ddsi_serdata* MakeDisposal(const ddsi_sertype* type, const void* wire);

/// A sample of such a type from bytes as they might come from the network; nullptr when they are
/// refused.
[[nodiscard]] ddsi_serdata* MakeSerdata(const ddsi_sertype* type, ddsi_serdata_kind kind,
                                        std::span<const char> bytes);

}  // namespace limbcast::bus::cyclone
