#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/base/ids.hpp"
#include "common/sensing/marg_sample.hpp"

namespace limbcast::sensing {

inline constexpr std::size_t kMaxSamplesPerFrame = 64;

/// The samples of all sensors of one body and one tick in one message, for gateways that carry many
/// people.
struct MargFrame {
  BodyId body_id;
  std::uint32_t gateway = 0;        ///< tells apart two gateways that carry one body
  std::vector<MargSample> samples;  ///< at most kMaxSamplesPerFrame
};

}  // namespace limbcast::sensing
