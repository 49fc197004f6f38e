#include "tests/unit/common/bus/endpoint_round_trip.hpp"

namespace limbcast::bus::testing {
namespace {

TEST(FastEndpointsSensingTest, MargSampleCrossesUnchanged) {
  ExpectCrossing<sensing::MargSample>(Vendor::kFast);
}
TEST(FastEndpointsSensingTest, MargFrameCrossesUnchanged) {
  ExpectCrossing<sensing::MargFrame>(Vendor::kFast);
}
TEST(FastEndpointsSensingTest, FusedOrientationCrossesUnchanged) {
  ExpectCrossing<sensing::FusedOrientation>(Vendor::kFast);
}
TEST(FastEndpointsSensingTest, CoilBurstCrossesUnchanged) {
  ExpectCrossing<sensing::CoilBurst>(Vendor::kFast);
}
TEST(FastEndpointsSensingTest, MarkerPositionCrossesUnchanged) {
  ExpectCrossing<sensing::MarkerPosition>(Vendor::kFast);
}
TEST(FastEndpointsSensingTest, PositionFixCrossesUnchanged) {
  ExpectCrossing<sensing::PositionFix>(Vendor::kFast);
}
TEST(FastEndpointsSensingTest, SensorInfoCrossesUnchanged) {
  ExpectCrossing<sensing::SensorInfo>(Vendor::kFast);
}

}  // namespace
}  // namespace limbcast::bus::testing
