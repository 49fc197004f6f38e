#pragma once

#include "common/base/time.hpp"

namespace limbcast::body {

/// When a tick passed each door on its way, for latency by stage. Epoch (zero) = has not passed
/// that door. A skeleton carries the times of the sample that completed its tick.
struct StageTimes {
  Time gateway_published_at{};
  Time fusion_received_at{};
  Time fusion_published_at{};
  Time posture_received_at{};
  Time posture_published_at{};
};

}  // namespace limbcast::body
