#include "tests/unit/common/bus/endpoint_round_trip.hpp"

namespace limbcast::bus::testing {
namespace {

TEST(CycloneEndpointsBodyTest, SegmentStateCrossesUnchanged) {
  ExpectCrossing<body::SegmentState>(Vendor::kCyclone);
}
TEST(CycloneEndpointsBodyTest, SegmentFrameCrossesUnchanged) {
  ExpectCrossing<body::SegmentFrame>(Vendor::kCyclone);
}
TEST(CycloneEndpointsBodyTest, SegmentTruthCrossesUnchanged) {
  ExpectCrossing<body::SegmentTruth>(Vendor::kCyclone);
}
TEST(CycloneEndpointsBodyTest, BodyDefinitionCrossesUnchanged) {
  ExpectCrossing<body::BodyDefinition>(Vendor::kCyclone);
}
TEST(CycloneEndpointsBodyTest, SkeletonCrossesUnchanged) {
  ExpectCrossing<body::Skeleton>(Vendor::kCyclone);
}
TEST(CycloneEndpointsBodyTest, JointAnglesCrossUnchanged) {
  ExpectCrossing<body::JointAngleFrame>(Vendor::kCyclone);
}
TEST(CycloneEndpointsBodyTest, ServiceHealthCrossesUnchanged) {
  ExpectCrossing<ServiceHealth>(Vendor::kCyclone);
}

}  // namespace
}  // namespace limbcast::bus::testing
