#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "common/base/result.hpp"
#include "common/body/body_definition.hpp"

namespace limbcast::body {

/// Limits of a body height that we compute with; outside of them a number is a slip of the pen.
inline constexpr double kMinBodyHeight_m = 0.5;
inline constexpr double kMaxBodyHeight_m = 2.5;
inline constexpr double kDefaultBodyHeight_m = 1.75;

/// All 23 segments of an average person of this height, untracked, unaligned, in the N-pose
/// (upright, arms hanging, palms inwards). Fails unless height_m is in
/// [kMinBodyHeight_m, kMaxBodyHeight_m].
///
/// Lengths are fractions of body height: Drillis & Contini 1966, "Body segment parameters", as
/// printed in Winter 2009, "Biomechanics and Motor Control of Human Movement", Fig. 4.1; what that
/// figure leaves out (parts of the spine, hip joint centres, ball of the foot) is our own and
/// marked so in the table of default_body.cpp. The origin of the pelvis is the middle between the
/// hip joint centres; the soles are kStandingRootHeight below it.
[[nodiscard]] Result<BodyDefinition> MakeDefaultBody(BodyId body_id,
                                                     double height_m = kDefaultBodyHeight_m);

/// Height of the pelvis origin over the floor in the reference pose, as a fraction of body height
/// (greater trochanter, Winter 2009 Fig. 4.1).
inline constexpr double kStandingRootHeight = 0.530;

/// The same person with only `kept` segments (pelvis always kept): children of a segment that is
/// left out move to its nearest kept ancestor, so that no joint moves in the reference pose.
[[nodiscard]] BodyDefinition KeepSegments(const BodyDefinition& body,
                                          std::span<const Segment> kept);

/// The 15 segments of the papers' sensor set: pelvis, T8, head, and upper arm, fore arm, hand,
/// upper leg, lower leg, foot on both sides.
[[nodiscard]] std::span<const Segment> ReducedSegments();

/// The 16 segments of recordings of a whole person: the papers' 15 and the lower back (L5), parents
/// before children.
[[nodiscard]] std::span<const Segment> SixteenSegments();

/// Makes one segment `length_m` long (range: [0.01, 1.0]), or the whole person `length_m` tall for
/// the name "height". The joints at the segment's outboard end move along.
///  - A segment: its length is measured from now on. The same segment of the other side becomes as
///    long, unless it was measured itself.
///  - "height": default proportions for all that was not measured; of trunk, head and legs what was
///    not measured is then stretched or squeezed alike until the person stands that tall. Without
///    some of the segments the height is that from the lowest to the highest point of what is
///    there.
/// Fails with the name and the limit, also when the measured lengths leave less than kMinStretch or
/// more than kMaxStretch of its usual size to the rest; `body` is then unchanged.
inline constexpr double kMinStretch = 0.7;
inline constexpr double kMaxStretch = 1.4;
[[nodiscard]] Status SetDimension(std::string_view name, double length_m, BodyDefinition& body);

/// The first thing that is wrong: no segment, first is not the pelvis, a segment twice, a parent
/// after its child, a number that is not finite, an offset longer than 2 m, q not of unit length.
[[nodiscard]] Status Validate(const BodyDefinition& body);

/// Index in `segments` of the nearest ancestor of `segment` that the body has; -1 for the root or
/// when there is none.
[[nodiscard]] int ParentIndex(const BodyDefinition& body, Segment segment);

/// Height of the standing person from the lowest to the highest point in the reference pose.
[[nodiscard]] double StandingHeight_m(const BodyDefinition& body);

}  // namespace limbcast::body
