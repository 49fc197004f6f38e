#include "tests/unit/common/bus/endpoint_round_trip.hpp"

namespace limbcast::bus::testing {
namespace {

TEST(FastEndpointsBodyTest, SegmentStateCrossesUnchanged) {
  ExpectCrossing<body::SegmentState>(Vendor::kFast);
}
TEST(FastEndpointsBodyTest, SegmentFrameCrossesUnchanged) {
  ExpectCrossing<body::SegmentFrame>(Vendor::kFast);
}
TEST(FastEndpointsBodyTest, SegmentTruthCrossesUnchanged) {
  ExpectCrossing<body::SegmentTruth>(Vendor::kFast);
}
TEST(FastEndpointsBodyTest, BodyDefinitionCrossesUnchanged) {
  ExpectCrossing<body::BodyDefinition>(Vendor::kFast);
}
TEST(FastEndpointsBodyTest, SkeletonCrossesUnchanged) {
  ExpectCrossing<body::Skeleton>(Vendor::kFast);
}
TEST(FastEndpointsBodyTest, JointAnglesCrossUnchanged) {
  ExpectCrossing<body::JointAngleFrame>(Vendor::kFast);
}
TEST(FastEndpointsBodyTest, ServiceHealthCrossesUnchanged) {
  ExpectCrossing<ServiceHealth>(Vendor::kFast);
}

}  // namespace
}  // namespace limbcast::bus::testing
