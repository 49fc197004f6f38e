#include "common/body/segment.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string_view>

namespace limbcast::body {
namespace {

TEST(SegmentTest, NamesAreUniqueAndParseBack) {
  std::set<std::string_view> names;
  for (const Segment segment : AllSegments()) {
    names.insert(ToString(segment));
    EXPECT_EQ(ParseSegment(ToString(segment)), segment);
  }
  EXPECT_EQ(names.size(), kSegmentCount);
  EXPECT_FALSE(ParseSegment("Pelvis").has_value());
  EXPECT_FALSE(ParseSegment("").has_value());
  EXPECT_EQ(ToString(static_cast<Segment>(23)), "unknown");
}

TEST(SegmentTest, EveryParentComesBeforeItsChildrenAndLeadsToThePelvis) {
  std::set<Segment> seen;
  for (const Segment segment : AllSegments()) {
    const auto parent = ParentOf(segment);
    EXPECT_EQ(parent.has_value(), segment != Segment::kPelvis);
    EXPECT_TRUE(!parent || seen.contains(*parent)) << ToString(segment);
    seen.insert(segment);
  }
}

TEST(SegmentTest, EverySegmentIsOfOnePart) {
  EXPECT_TRUE(IsTrunk(Segment::kHead));
  EXPECT_FALSE(IsTrunk(Segment::kRightShoulder));
  EXPECT_TRUE(IsLeg(Segment::kLeftToe));
  EXPECT_TRUE(IsArm(Segment::kLeftHand));
  EXPECT_FALSE(IsArm(Segment::kLeftShoulder));
}

}  // namespace
}  // namespace limbcast::body
