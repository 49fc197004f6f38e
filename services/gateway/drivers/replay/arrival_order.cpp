#include "services/gateway/drivers/replay/arrival_order.hpp"

#include <algorithm>

namespace limbcast::gateway {

void BuildTicks(Collected collected, Recording& recording) {
  std::stable_sort(
      collected.arrived.begin(), collected.arrived.end(),
      [](const ArrivedSample& a, const ArrivedSample& b) { return a.arrived_at < b.arrived_at; });
  recording.marg.reserve(collected.marg.size());
  recording.orientation.reserve(collected.orientation.size());
  recording.truth.reserve(collected.truth.size());

  const std::size_t count = collected.arrived.size();
  std::uint64_t lost = 0;
  std::uint8_t movement = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const ArrivedSample& arrived = collected.arrived[i];
    Time measured_at{};
    if (arrived.kind == ArrivedSample::Kind::kMarg) {
      recording.marg.push_back(collected.marg[arrived.index]);
      measured_at = recording.marg.back().measured_at;
    } else {
      recording.orientation.push_back(collected.orientation[arrived.index]);
      measured_at = recording.orientation.back().measured_at;
    }
    if (arrived.truth >= 0) {
      recording.truth.push_back(collected.truth[static_cast<std::size_t>(arrived.truth)]);
    }
    recording.out_of_order += measured_at < arrived.arrived_at ? 1U : 0U;
    lost += arrived.lost_before;
    movement = std::max(movement, arrived.movement);

    if (i + 1 == count || collected.arrived[i + 1].arrived_at != arrived.arrived_at) {
      CloseTick(recording, arrived.arrived_at, lost);
      if (collected.has_movement) {
        recording.movement.push_back(movement);
      }
      lost = 0;
      movement = 0;
    }
  }
}

}  // namespace limbcast::gateway
