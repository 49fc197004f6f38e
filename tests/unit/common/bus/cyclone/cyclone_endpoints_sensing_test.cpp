#include "tests/unit/common/bus/endpoint_round_trip.hpp"

namespace limbcast::bus::testing {
namespace {

TEST(CycloneEndpointsSensingTest, MargSampleCrossesUnchanged) {
  ExpectCrossing<sensing::MargSample>(Vendor::kCyclone);
}
TEST(CycloneEndpointsSensingTest, MargFrameCrossesUnchanged) {
  ExpectCrossing<sensing::MargFrame>(Vendor::kCyclone);
}
TEST(CycloneEndpointsSensingTest, FusedOrientationCrossesUnchanged) {
  ExpectCrossing<sensing::FusedOrientation>(Vendor::kCyclone);
}
TEST(CycloneEndpointsSensingTest, CoilBurstCrossesUnchanged) {
  ExpectCrossing<sensing::CoilBurst>(Vendor::kCyclone);
}
TEST(CycloneEndpointsSensingTest, MarkerPositionCrossesUnchanged) {
  ExpectCrossing<sensing::MarkerPosition>(Vendor::kCyclone);
}
TEST(CycloneEndpointsSensingTest, PositionFixCrossesUnchanged) {
  ExpectCrossing<sensing::PositionFix>(Vendor::kCyclone);
}
TEST(CycloneEndpointsSensingTest, SensorInfoCrossesUnchanged) {
  ExpectCrossing<sensing::SensorInfo>(Vendor::kCyclone);
}

}  // namespace
}  // namespace limbcast::bus::testing
