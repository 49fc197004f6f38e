#pragma once

#include <cstddef>

#include "common/base/position_kind.hpp"
#include "common/base/tracking.hpp"
#include "common/base/verdict.hpp"
#include "common/body/joint_angles.hpp"
#include "common/body/segment.hpp"
#include "common/body/skeleton.hpp"
#include "common/roster/command.hpp"
#include "common/roster/session.hpp"

namespace limbcast::bus {

/// The highest enumerator that travels; a receiver refuses numbers above it. Only the enums below
/// have one.
template <typename E>
inline constexpr E kLastOf = E{};

template <>
inline constexpr HeadingReference kLastOf<HeadingReference> = HeadingReference::kTrue;
template <>
inline constexpr FillKind kLastOf<FillKind> = FillKind::kPolynomial;
template <>
inline constexpr PositionReference kLastOf<PositionReference> = PositionReference::kSensor;
template <>
inline constexpr MagneticState kLastOf<MagneticState> = MagneticState::kDisturbed;
template <>
inline constexpr SampleVerdict kLastOf<SampleVerdict> = SampleVerdict::kRejectedOverload;
template <>
inline constexpr body::Segment kLastOf<body::Segment> = body::Segment::kLeftToe;
template <>
inline constexpr body::SegmentStatus kLastOf<body::SegmentStatus> = body::SegmentStatus::kFilled;
template <>
inline constexpr body::Joint kLastOf<body::Joint> = body::Joint::kLeftWrist;
template <>
inline constexpr roster::Role kLastOf<roster::Role> = roster::Role::kOperator;
template <>
inline constexpr roster::CommandKind kLastOf<roster::CommandKind> =
    roster::CommandKind::kCountSessions;

static_assert(static_cast<std::size_t>(kLastOf<SampleVerdict>) + 1 == kSampleVerdictCount);
static_assert(static_cast<std::size_t>(kLastOf<body::Segment>) + 1 == body::kSegmentCount);
static_assert(static_cast<std::size_t>(kLastOf<body::Joint>) + 1 == body::kJointCount);

}  // namespace limbcast::bus
