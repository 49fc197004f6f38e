#include "common/body/body_definition.hpp"

#include <algorithm>
#include <utility>

namespace limbcast::body {

const SegmentDefinition* Find(const BodyDefinition& body, Segment segment) {
  const auto found = std::find_if(body.segments.begin(), body.segments.end(),
                                  [&](const SegmentDefinition& s) { return s.segment == segment; });
  return found == body.segments.end() ? nullptr : &*found;
}

SegmentDefinition* Find(BodyDefinition& body, Segment segment) {
  const SegmentDefinition* found = Find(std::as_const(body), segment);
  return found == nullptr ? nullptr
                          : &body.segments[static_cast<std::size_t>(found - body.segments.data())];
}

void TakeDimensions(const SegmentDefinition& from, SegmentDefinition& into) {
  into.p_parent_segment_m = from.p_parent_segment_m;
  into.p_segment_end_m = from.p_segment_end_m;
  into.length_measured = from.length_measured;
}

void TakeAlignment(const SegmentDefinition& from, SegmentDefinition& into) {
  into.q_sensor_segment = from.q_sensor_segment;
  into.heading_correction_rad = from.heading_correction_rad;
  into.aligned = from.aligned;
  into.alignment_quality = from.alignment_quality;
}

}  // namespace limbcast::body
