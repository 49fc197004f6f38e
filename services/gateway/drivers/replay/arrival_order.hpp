#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/base/time.hpp"
#include "services/gateway/drivers/replay/recording.hpp"

namespace limbcast::gateway {

/// One sample of one sensor while a reader still collects them.
struct ArrivedSample {
  enum class Kind : std::uint8_t { kMarg, kOrientation };
  Kind kind = Kind::kMarg;
  std::size_t sensor = 0;  ///< index into Recording::sensors
  std::size_t index = 0;   ///< into the vectors handed to BuildTicks
  Time arrived_at{};       ///< the latest measured_at of its sensor so far: never goes back
  std::uint64_t lost_before = 0;
  std::int64_t truth = -1;  ///< index of the truth that came with it; -1 = none
  std::uint8_t movement = 0;
};

/// What readers of sensor-by-sensor or row-by-row files collect before the ticks are known.
struct Collected {
  std::vector<sensing::MargSample> marg;
  std::vector<sensing::FusedOrientation> orientation;
  std::vector<body::SegmentTruth> truth;
  std::vector<ArrivedSample> arrived;
  bool has_movement = false;
};

/// Puts everything in the order of arrival into `recording` and cuts it into ticks: samples with
/// the same arrived_at form one tick. A sample whose own measured_at is older (out of order in the
/// file) stays where it stood, with its old time, for the fusion service to refuse.
void BuildTicks(Collected collected, Recording& recording);

}  // namespace limbcast::gateway
