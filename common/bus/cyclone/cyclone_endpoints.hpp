#pragma once

#include <memory>

#include "common/base/result.hpp"
#include "common/bus/reader.hpp"
#include "common/bus/writer.hpp"

namespace limbcast::bus::cyclone {

class CycloneParticipant;

/// Instantiated for every topic by the cyclone_endpoints_*.cpp, so that nobody else compiles them.
template <typename T>
[[nodiscard]] Result<std::unique_ptr<Writer<T>>> MakeCycloneWriter(CycloneParticipant& participant);
template <typename T>
[[nodiscard]] Result<std::unique_ptr<Reader<T>>> MakeCycloneReader(CycloneParticipant& participant,
                                                                   ReaderHandler<T> handler);

}  // namespace limbcast::bus::cyclone
