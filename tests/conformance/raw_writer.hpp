#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "common/base/result.hpp"
#include "common/bus/bus_config.hpp"
#include "tests/conformance/topic_writer.hpp"

namespace limbcast::conformance {

/// Sends any bytes as a sample of a topic, with the topic's own type name and QoS, past every
/// codec: what a broken or hostile peer does.
class RawWriter {
 public:
  virtual ~RawWriter() = default;
  /// `payload` starts with the encapsulation header.
  [[nodiscard]] virtual Status Write(const Bytes& payload) = 0;
};

[[nodiscard]] Result<std::unique_ptr<RawWriter>> MakeRawFastWriter(const bus::BusConfig& config,
                                                                   const TopicNames& names);
[[nodiscard]] Result<std::unique_ptr<RawWriter>> MakeRawCycloneWriter(const bus::BusConfig& config,
                                                                      const TopicNames& names);

}  // namespace limbcast::conformance
