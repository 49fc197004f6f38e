#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "common/base/time.hpp"
#include "common/body/skeleton.hpp"
#include "common/runtime/latency_histogram.hpp"

namespace limbcast::tool {

/// Where the time between a sensor and a client goes, skeleton by skeleton. A skeleton carries the
/// times of the sample that completed its tick. A recording that is played faster than it was made
/// is ahead of the clock; its way is measured from the gateway on. Thread-compatible.
class StageLatencies {
 public:
  static constexpr std::array<std::string_view, 6> kNames = {
      "gateway",            // measured -> handed to the bus
      "gateway_to_fusion",  // on the way
      "fusion",             // received -> handed to the bus
      "fusion_to_posture",  // on the way
      "posture",            // received -> handed to the bus
      "posture_to_client",  // on the way
  };

  void Add(const body::Skeleton& skeleton, Time received_at);

  /// Forgets what was added.
  void Restart();

  [[nodiscard]] const runtime::LatencyHistogram& total() const { return total_; }
  [[nodiscard]] const runtime::LatencyHistogram& stage(std::size_t index) const {
    return stages_[index];
  }

 private:
  runtime::LatencyHistogram total_;
  std::array<runtime::LatencyHistogram, kNames.size()> stages_;
};

}  // namespace limbcast::tool
