#pragma once

#include <memory>

#include "common/base/result.hpp"
#include "common/bus/reader.hpp"
#include "common/bus/writer.hpp"

namespace limbcast::bus::fastdds {

class FastParticipant;

/// Instantiated for every topic by the fast_endpoints_*.cpp, so that nobody else compiles them.
template <typename T>
[[nodiscard]] Result<std::unique_ptr<Writer<T>>> MakeFastWriter(FastParticipant& participant);
template <typename T>
[[nodiscard]] Result<std::unique_ptr<Reader<T>>> MakeFastReader(FastParticipant& participant,
                                                                ReaderHandler<T> handler);

}  // namespace limbcast::bus::fastdds
