#pragma once

#include <cstddef>
#include <vector>

#include "common/base/ids.hpp"
#include "common/body/segment_state.hpp"

namespace limbcast::body {

inline constexpr std::size_t kMaxStatesPerFrame = 64;

/// Segment states of one body in one message, in the order in which they came to be; each is what
/// the topic `segment_state` would carry. For fusion services that carry many people.
struct SegmentFrame {
  BodyId body_id;
  std::vector<SegmentState> states;  ///< at most kMaxStatesPerFrame; all of body_id
};

}  // namespace limbcast::body
