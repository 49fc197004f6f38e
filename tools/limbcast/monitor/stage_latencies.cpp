#include "tools/limbcast/monitor/stage_latencies.hpp"

namespace limbcast::tool {

void StageLatencies::Add(const body::Skeleton& skeleton, Time received_at) {
  const body::StageTimes& at = skeleton.stages;
  const std::array<Time, kNames.size() + 1> doors = {skeleton.measured_at,
                                                     at.gateway_published_at,
                                                     at.fusion_received_at,
                                                     at.fusion_published_at,
                                                     at.posture_received_at,
                                                     at.posture_published_at,
                                                     received_at};
  // A recording that is played faster than it was made runs ahead of the clock: then the way
  // begins where the gateway handed the sample over.
  const bool ahead = skeleton.measured_at > at.gateway_published_at && doors[1] != Time{};
  total_.Record(received_at - doors[ahead ? 1 : 0]);
  for (std::size_t i = ahead ? 1 : 0; i < kNames.size(); ++i) {
    if (doors[i] != Time{} && doors[i + 1] != Time{}) {  // epoch = has not passed that door
      stages_[i].Record(doors[i + 1] - doors[i]);
    }
  }
}

void StageLatencies::Restart() {
  (void)total_.Take("");
  for (runtime::LatencyHistogram& stage : stages_) {
    (void)stage.Take("");
  }
}

}  // namespace limbcast::tool
