#include "common/body/default_body.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace limbcast::body {
namespace {

/// A joint centre in the reference pose, in fractions of body height: x forward, z over the floor;
/// y to the left, given for the left side and mirrored for the right.
struct Point {
  double x;
  double y;
  double z;
};

struct Row {
  Segment segment;
  Point inboard;
  Point outboard;
};

// Fractions without a remark: Drillis & Contini 1966 in Winter 2009, Fig. 4.1 (ankle 0.039, knee
// 0.285, hip 0.530, shoulder 0.818 over the floor; half the shoulder breadth 0.129; upper arm
// 0.186, fore arm 0.146, hand 0.108; foot length 0.152).
// Our own, chosen between those: L5/S1 0.585, L4/L3 0.625, L1/T12 0.665, T9/T8 0.715, T1/C7 0.840,
// C1/head 0.900; sternal end of the shoulder 0.020 beside the middle; hip joint centres 0.100
// apart (17.5 cm at 1.75 m; 72 % of the width between the iliac spines after Bell, Brand,
// Pedersen 1990); ball of the foot 0.075 before the ankle and 0.012 over the floor, tip of the toes
// 0.115 before the ankle on the floor, which leaves 0.037 for the heel.
constexpr std::array<Row, 7> kTrunk = {{
    {Segment::kPelvis, {0.0, 0.0, kStandingRootHeight}, {0.0, 0.0, 0.585}},
    {Segment::kL5, {0.0, 0.0, 0.585}, {0.0, 0.0, 0.625}},
    {Segment::kL3, {0.0, 0.0, 0.625}, {0.0, 0.0, 0.665}},
    {Segment::kT12, {0.0, 0.0, 0.665}, {0.0, 0.0, 0.715}},
    {Segment::kT8, {0.0, 0.0, 0.715}, {0.0, 0.0, 0.840}},
    {Segment::kNeck, {0.0, 0.0, 0.840}, {0.0, 0.0, 0.900}},
    {Segment::kHead, {0.0, 0.0, 0.900}, {0.0, 0.0, 1.000}},
}};
constexpr std::array<Row, 8> kLeftLimbs = {{
    {Segment::kLeftShoulder, {0.0, 0.020, 0.818}, {0.0, 0.129, 0.818}},
    {Segment::kLeftUpperArm, {0.0, 0.129, 0.818}, {0.0, 0.129, 0.632}},
    {Segment::kLeftForeArm, {0.0, 0.129, 0.632}, {0.0, 0.129, 0.486}},
    {Segment::kLeftHand, {0.0, 0.129, 0.486}, {0.0, 0.129, 0.378}},
    {Segment::kLeftUpperLeg, {0.0, 0.050, kStandingRootHeight}, {0.0, 0.050, 0.285}},
    {Segment::kLeftLowerLeg, {0.0, 0.050, 0.285}, {0.0, 0.050, 0.039}},
    {Segment::kLeftFoot, {0.0, 0.050, 0.039}, {0.075, 0.050, 0.012}},
    {Segment::kLeftToe, {0.075, 0.050, 0.012}, {0.115, 0.050, 0.000}},
}};

bool IsRight(Segment segment) {
  return (segment >= Segment::kRightShoulder && segment <= Segment::kRightHand) ||
         (segment >= Segment::kRightUpperLeg && segment <= Segment::kRightToe);
}

/// The same limb on the left (right arm 7–10 → 11–14, right leg 15–18 → 19–22).
Segment LeftOf(Segment segment) {
  return IsRight(segment) ? static_cast<Segment>(Index(segment) + 4) : segment;
}

const Row& RowOf(Segment segment) {
  if (Index(segment) < kTrunk.size()) {
    return kTrunk[Index(segment)];
  }
  const auto row = std::find_if(kLeftLimbs.begin(), kLeftLimbs.end(),
                                [&](const Row& r) { return r.segment == LeftOf(segment); });
  Expects(row != kLeftLimbs.end(), "a known segment");
  return *row;
}

Eigen::Vector3d Scaled(const Point& point, Segment segment, double height_m) {
  const double side = IsRight(segment) ? -1.0 : 1.0;
  return height_m * Eigen::Vector3d(point.x, side * point.y, point.z);
}

/// Hinges only: wide limits in which the rotation vector about the parent makes sense. Positive y
/// brings the outboard end backwards: knees bend to +y, elbows to −y.
void SetJointLimits(SegmentDefinition& definition) {
  const Segment left = LeftOf(definition.segment);
  if (left == Segment::kLeftLowerLeg) {
    definition.joint_min_rad = {-0.5, -0.1, -0.8};
    definition.joint_max_rad = {0.5, 2.7, 0.8};
  } else if (left == Segment::kLeftForeArm) {
    definition.joint_min_rad = {-0.6, -2.7, -2.0};
    definition.joint_max_rad = {0.6, 0.2, 2.0};
  }
}

std::string InRange(std::string_view what, double low, double high, double is) {
  std::ostringstream text;
  text << what << " must be in [" << low << ", " << high << "] m, is " << is;
  return text.str();
}

Error Invalid(std::string message) {
  return Error{ErrorCode::kInvalidArgument, std::move(message)};
}

Segment OtherSide(Segment segment) {
  if (IsRight(segment)) {
    return LeftOf(segment);
  }
  const auto right = static_cast<Segment>(Index(segment) - 4);
  return Index(segment) >= 4 && IsRight(right) ? right : segment;
}

bool MeasuredOn(const BodyDefinition& body, Segment segment) {
  const SegmentDefinition* found = Find(body, segment);
  return found != nullptr && found->length_measured;
}

/// Makes a segment `factor` times as long. The joints at its end move along; `all_joints`: those
/// that sit elsewhere on it do too.
void Stretch(SegmentDefinition& segment, double factor, bool all_joints, BodyDefinition& body) {
  const auto index = static_cast<int>(&segment - body.segments.data());
  for (SegmentDefinition& child : body.segments) {
    if (ParentIndex(body, child.segment) == index &&
        (all_joints || child.p_parent_segment_m.isApprox(segment.p_segment_end_m, 1e-6))) {
      child.p_parent_segment_m *= factor;
    }
  }
  segment.p_segment_end_m *= factor;
}

/// What adds up to the height: trunk, neck, head, thighs and shanks.
bool IsUpright(Segment segment) {
  const Segment left = LeftOf(segment);
  return segment <= Segment::kHead || left == Segment::kLeftUpperLeg ||
         left == Segment::kLeftLowerLeg;
}

/// Stretches the upright segments that are not measured until the person stands `height_m` tall.
/// The height is linear in the factor.
Status StretchToHeight(double height_m, BodyDefinition& body) {
  const auto stretched = [&](double factor) {
    BodyDefinition result = body;
    for (SegmentDefinition& segment : result.segments) {
      if (IsUpright(segment.segment) && !segment.length_measured &&
          !MeasuredOn(result, OtherSide(segment.segment))) {
        Stretch(segment, factor, true, result);
      }
    }
    return result;
  };
  const double as_it_is_m = StandingHeight_m(body);
  const double slope_m = 10.0 * (StandingHeight_m(stretched(1.1)) - as_it_is_m);
  const double factor = 1.0 + (height_m - as_it_is_m) / slope_m;
  if (!(factor >= kMinStretch && factor <= kMaxStretch)) {
    std::ostringstream text;
    text << "the measured lengths do not fit a height of " << height_m
         << " m: the rest would have to be " << factor
         << " times its usual size, which must be in [" << kMinStretch << ", " << kMaxStretch
         << "]";
    return Invalid(text.str());
  }
  body = stretched(factor);
  return Ok();
}

Status SetHeight(double height_m, BodyDefinition& body) {
  const auto fresh = MakeDefaultBody(body.body_id, height_m);
  if (!fresh) {
    return fresh.error();
  }
  std::vector<Segment> kept;
  kept.reserve(body.segments.size());
  for (const SegmentDefinition& definition : body.segments) {
    kept.push_back(definition.segment);
  }
  const BodyDefinition scaled = KeepSegments(*fresh, kept);
  BodyDefinition changed = body;
  for (SegmentDefinition& definition : changed.segments) {
    const SegmentDefinition* source = Find(scaled, definition.segment);
    definition.p_parent_segment_m = source->p_parent_segment_m;
    definition.p_segment_end_m = source->p_segment_end_m;
  }
  const double default_m = StandingHeight_m(changed);
  bool measured = false;
  for (const SegmentDefinition& before : body.segments) {
    if (before.length_measured || MeasuredOn(body, OtherSide(before.segment))) {
      SegmentDefinition& now = *Find(changed, before.segment);
      Stretch(now, before.p_segment_end_m.norm() / now.p_segment_end_m.norm(), false, changed);
      measured = true;
    }
  }
  if (measured) {
    if (Status fits = StretchToHeight(default_m, changed); !fits) {
      return fits;
    }
  }
  body = std::move(changed);
  return Ok();
}

}  // namespace

Result<BodyDefinition> MakeDefaultBody(BodyId body_id, double height_m) {
  if (!(height_m >= kMinBodyHeight_m && height_m <= kMaxBodyHeight_m)) {
    return Invalid(InRange("height", kMinBodyHeight_m, kMaxBodyHeight_m, height_m));
  }
  BodyDefinition body;
  body.body_id = body_id;
  body.segments.reserve(kSegmentCount);
  for (const Segment segment : AllSegments()) {
    SegmentDefinition definition;
    definition.segment = segment;
    const Eigen::Vector3d inboard_m = Scaled(RowOf(segment).inboard, segment, height_m);
    if (const auto parent = ParentOf(segment)) {
      definition.p_parent_segment_m = inboard_m - Scaled(RowOf(*parent).inboard, *parent, height_m);
    }
    definition.p_segment_end_m = Scaled(RowOf(segment).outboard, segment, height_m) - inboard_m;
    SetJointLimits(definition);
    body.segments.push_back(definition);
  }
  return body;
}

BodyDefinition KeepSegments(const BodyDefinition& body, std::span<const Segment> kept) {
  const auto keeps = [&](Segment segment) {
    return segment == Segment::kPelvis ||
           std::find(kept.begin(), kept.end(), segment) != kept.end();
  };
  BodyDefinition reduced = body;
  reduced.segments.clear();
  for (SegmentDefinition definition : body.segments) {
    if (!keeps(definition.segment)) {
      continue;
    }
    for (int parent = ParentIndex(body, definition.segment); parent >= 0;
         parent = ParentIndex(body, body.segments[static_cast<std::size_t>(parent)].segment)) {
      const SegmentDefinition& ancestor = body.segments[static_cast<std::size_t>(parent)];
      if (keeps(ancestor.segment)) {
        break;
      }
      definition.p_parent_segment_m += ancestor.p_parent_segment_m;
    }
    reduced.segments.push_back(definition);
  }
  return reduced;
}

std::span<const Segment> ReducedSegments() {
  static constexpr std::array<Segment, 15> kReduced = {
      Segment::kPelvis,        Segment::kT8,
      Segment::kHead,          Segment::kRightUpperArm,
      Segment::kRightForeArm,  Segment::kRightHand,
      Segment::kLeftUpperArm,  Segment::kLeftForeArm,
      Segment::kLeftHand,      Segment::kRightUpperLeg,
      Segment::kRightLowerLeg, Segment::kRightFoot,
      Segment::kLeftUpperLeg,  Segment::kLeftLowerLeg,
      Segment::kLeftFoot};
  return kReduced;
}

std::span<const Segment> SixteenSegments() {
  static const std::vector<Segment> kSixteen = [] {
    std::vector<Segment> all{Segment::kPelvis, Segment::kL5};
    const auto reduced = ReducedSegments();
    all.insert(all.end(), reduced.begin() + 1, reduced.end());
    return all;
  }();
  return kSixteen;
}

Status SetDimension(std::string_view name, double length_m, BodyDefinition& body) {
  if (name == "height") {
    return SetHeight(length_m, body);
  }
  const auto segment = ParseSegment(name);
  SegmentDefinition* changed = segment ? Find(body, *segment) : nullptr;
  if (changed == nullptr) {
    return Invalid("dimension \"" + std::string(name.substr(0, 40)) +
                   "\" is neither \"height\" nor a segment of this body");
  }
  constexpr double kMin_m = 0.01;
  constexpr double kMax_m = 1.0;
  if (!(length_m >= kMin_m && length_m <= kMax_m)) {
    return Invalid(InRange(name, kMin_m, kMax_m, length_m));
  }
  changed->length_measured = true;
  Stretch(*changed, length_m / changed->p_segment_end_m.norm(), false, body);
  SegmentDefinition* other = Find(body, OtherSide(*segment));
  if (other != nullptr && !other->length_measured) {
    Stretch(*other, length_m / other->p_segment_end_m.norm(), false, body);
  }
  return Ok();
}

Status Validate(const BodyDefinition& body) {
  if (body.segments.empty() || body.segments.front().segment != Segment::kPelvis) {
    return Invalid("a body must begin with the pelvis");
  }
  std::array<bool, kSegmentCount> seen{};
  for (const SegmentDefinition& definition : body.segments) {
    const std::string name(ToString(definition.segment));
    if (Index(definition.segment) >= kSegmentCount) {
      return Invalid("segment number " + std::to_string(Index(definition.segment)) +
                     " must be below " + std::to_string(kSegmentCount));
    }
    if (seen[Index(definition.segment)]) {
      return Invalid("segment " + name + " is there twice");
    }
    for (auto ancestor = ParentOf(definition.segment); ancestor; ancestor = ParentOf(*ancestor)) {
      if (!seen[Index(*ancestor)] && Find(body, *ancestor) != nullptr) {
        return Invalid("segment " + name + " must come after its parent " +
                       std::string(ToString(*ancestor)));
      }
    }
    seen[Index(definition.segment)] = true;

    constexpr double kMaxOffset_m = 2.0;
    for (const Eigen::Vector3d& offset_m :
         {definition.p_parent_segment_m, definition.p_segment_end_m}) {
      if (!offset_m.allFinite() || offset_m.norm() > kMaxOffset_m) {
        return Invalid("an offset of " + name + " must be finite and at most 2 m long");
      }
    }
    if (!(std::abs(definition.q_sensor_segment.norm() - 1.0) < 1e-6)) {
      return Invalid("q_sensor_segment of " + name + " must be of unit length");
    }
  }
  return Ok();
}

int ParentIndex(const BodyDefinition& body, Segment segment) {
  for (auto ancestor = ParentOf(segment); ancestor; ancestor = ParentOf(*ancestor)) {
    if (const SegmentDefinition* found = Find(body, *ancestor)) {
      return static_cast<int>(found - body.segments.data());
    }
  }
  return -1;
}

double StandingHeight_m(const BodyDefinition& body) {
  std::vector<Eigen::Vector3d> inboard_m(body.segments.size());
  double low_m = 0.0;
  double high_m = 0.0;
  for (std::size_t i = 0; i < body.segments.size(); ++i) {
    const int parent = ParentIndex(body, body.segments[i].segment);
    inboard_m[i] = body.segments[i].p_parent_segment_m;
    if (parent >= 0) {
      inboard_m[i] += inboard_m[static_cast<std::size_t>(parent)];
    }
    const double end_m = inboard_m[i].z() + body.segments[i].p_segment_end_m.z();
    low_m = std::min({low_m, inboard_m[i].z(), end_m});
    high_m = std::max({high_m, inboard_m[i].z(), end_m});
  }
  return high_m - low_m;
}

}  // namespace limbcast::body
