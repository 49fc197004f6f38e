#include "services/gateway/drivers/simulator/simulated_cameras.hpp"

#include <gtest/gtest.h>

#include "common/config/config_file.hpp"
#include "services/gateway/drivers/simulator/simulator_driver.hpp"

namespace limbcast::gateway {
namespace {

SimulatorConfig WithCameras() {
  SimulatorConfig config;
  config.cameras.markers = {body::Segment::kPelvis, body::Segment::kLeftHand};
  config.cameras.errors.sigma_m = 0.0;
  return config;
}

TEST(SimulatedCamerasTest, ReadsItsSection) {
  const auto file = config::ConfigFile::Parse(
      "[c]\nmarkers = [\"t8\"]\nnoise_mm = 1.5\nlever_arm_m = [0.1, 0, -0.1]\nlead_s = 0.003\n",
      "c.toml");
  const SimulatedCamerasConfig config = ReadSimulatedCameras(file->Get("c"), {});
  EXPECT_TRUE(file->Finish());
  EXPECT_EQ(config.markers, std::vector{body::Segment::kT8});
  EXPECT_DOUBLE_EQ(config.errors.sigma_m, 1.5e-3);
  EXPECT_EQ(config.p_sensor_marker_m, Eigen::Vector3d(0.1, 0.0, -0.1));
  EXPECT_DOUBLE_EQ(config.lead_s, 0.003);
}

TEST(SimulatedCamerasTest, MarkersAreWhereTheTruthOfTheirSensorPutsThem) {
  const auto driver = SimulatorDriver::Make(WithCameras());
  ASSERT_TRUE(driver);
  Batch batch;
  for (int tick = 0; tick < 900; ++tick) {
    ASSERT_TRUE((*driver)->Next(batch));
    ASSERT_EQ(batch.markers.size(), 2U);
    for (const sensing::MarkerPosition& marker : batch.markers) {
      EXPECT_EQ(marker.measured_at, batch.tick_at);
      EXPECT_TRUE(marker.visible);
      for (const body::SegmentTruth& truth : batch.truth) {
        if (body::Index(truth.segment) == marker.marker) {
          const Eigen::Vector3d expected_m =
              truth.p_earth_sensor_m + truth.q_earth_sensor * Eigen::Vector3d(0.0, 0.0, 0.02);
          EXPECT_LT((marker.p_earth_marker_m - expected_m).norm(), 1e-9);
        }
      }
    }
  }
}

TEST(SimulatedCamerasTest, StampsThatLeadShowWhereTheMarkerWillBe) {
  SimulatorConfig config = WithCameras();
  const auto exact = SimulatorDriver::Make(config);
  config.cameras.lead_s = 0.02;  // two ticks
  const auto leading = SimulatorDriver::Make(config);
  Batch ahead;
  Batch batch;
  for (int tick = 0; tick < 802; ++tick) {
    ASSERT_TRUE((*exact)->Next(batch));
    if (tick < 800) {
      ASSERT_TRUE((*leading)->Next(ahead));
    }
  }
  EXPECT_LT((ahead.markers[0].p_earth_marker_m - batch.markers[0].p_earth_marker_m).norm(), 1e-9);
}

TEST(SimulatedCamerasTest, CamerasHaveARateOfTheirOwn) {
  SimulatorConfig config = WithCameras();
  config.cameras.rate_hz = 240.0;
  const auto driver = SimulatorDriver::Make(config);
  Batch batch;
  std::size_t seen = 0;
  Time last{};
  for (int tick = 0; tick <= 100; ++tick) {  // 0 to 1 s, both ends
    ASSERT_TRUE((*driver)->Next(batch));
    seen += batch.markers.size();
    for (const sensing::MarkerPosition& marker : batch.markers) {
      EXPECT_LE(marker.measured_at, batch.tick_at + std::chrono::nanoseconds(10));
      EXPECT_GE(marker.measured_at, last);
      last = marker.measured_at;
    }
  }
  EXPECT_EQ(seen, 2U * 241U);
}

TEST(SimulatedCamerasTest, AMarkerOnASegmentWithoutSensorIsRefused) {
  SimulatorConfig config = WithCameras();
  config.cameras.markers = {body::Segment::kL3};
  const auto driver = SimulatorDriver::Make(config);
  ASSERT_FALSE(driver);
  EXPECT_NE(driver.error().message.find("cameras.markers: l3"), std::string::npos);
}

}  // namespace
}  // namespace limbcast::gateway
