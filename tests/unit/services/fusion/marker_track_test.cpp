#include "services/fusion/marker_track.hpp"

#include <gtest/gtest.h>

#include "tests/support/position_run.hpp"

namespace limbcast::fusion {
namespace {

using test_support::RunPositions;

gateway::SimulatorConfig Walker() {
  gateway::SimulatorConfig config;
  config.n_pose_s = 1.0;
  config.cameras.markers = {body::Segment::kPelvis};
  return config;
}

PositionConfig PelvisMarker() {
  PositionConfig config;
  config.markers.segments = {body::Segment::kPelvis};
  return config;
}

constexpr std::pair<std::uint32_t, body::Segment> kPelvisOfOne = {1U, body::Segment::kPelvis};

// The pelvis of a walker is never still: what is heard from the middle of a walk on must do.
TEST(MarkerTrackTest, StartsInTheMiddleOfAWalk) {
  for (const double heading_error_rad : {0.0, 0.1, -0.15}) {
    const auto figures = RunPositions(Walker(), PelvisMarker(), 16.0, 10.0, heading_error_rad, 8.0);
    const auto& pelvis = figures.at(kPelvisOfOne);
    EXPECT_GT(pelvis.first_s, 8.0);
    EXPECT_LT(pelvis.first_s, 8.5) << heading_error_rad;
    EXPECT_EQ(pelvis.count, pelvis.expected);
    // The pelvis hardly turns: the lever arm of 2 cm that nobody told is found slowly.
    EXPECT_LT(pelvis.rms_m, 0.016) << heading_error_rad;
    EXPECT_LT(pelvis.max_m, 0.03) << heading_error_rad;
  }
}

TEST(MarkerTrackTest, StartsWhileStandingToo) {
  const auto figures = RunPositions(Walker(), PelvisMarker(), 0.9, 0.6);
  const auto& pelvis = figures.at(kPelvisOfOne);
  EXPECT_LT(pelvis.first_s, 0.5);
  // The lever arm does not show before the sensor turns.
  EXPECT_LT(pelvis.max_m, 0.03);
}

TEST(MarkerTrackTest, GapsGhostsSwapsAndALeadOfTheStampsAreBorne) {
  gateway::SimulatorConfig simulator = Walker();
  simulator.cameras.markers = {body::Segment::kPelvis, body::Segment::kT8};
  simulator.cameras.lead_s = 0.004;
  simulator.cameras.errors.gap_rate_hz = 0.3;
  simulator.cameras.errors.gap_s = 0.4;
  simulator.cameras.errors.ghost_rate = 0.01;
  simulator.cameras.errors.swap_rate_hz = 0.1;
  simulator.cameras.errors.swap_s = 0.15;
  const auto figures = RunPositions(simulator, PelvisMarker(), 40.0, 8.0);
  const auto& pelvis = figures.at(kPelvisOfOne);
  EXPECT_GT(pelvis.count, 0.98 * pelvis.expected);
  EXPECT_LT(pelvis.rms_m, 0.02);
}

TEST(MarkerTrackTest, WhatComesAfterAGapMendsItASecondLater) {
  gateway::SimulatorConfig simulator = Walker();
  simulator.cameras.errors.gap_rate_hz = 0.5;
  simulator.cameras.errors.gap_s = 0.8;
  PositionConfig config = PelvisMarker();
  const Eigen::Vector3d& lever_m = simulator.cameras.p_sensor_marker_m;
  config.markers.filter.lever_arm_x_m = lever_m.x();
  config.markers.filter.lever_arm_y_m = lever_m.y();
  config.markers.filter.lever_arm_z_m = lever_m.z();
  config.lag_s = 1.0;
  const auto figures = RunPositions(simulator, config, 40.0, 10.0);
  const auto& pelvis = figures.at(kPelvisOfOne);
  EXPECT_GT(pelvis.lagged_count, 0.98 * pelvis.expected);
  EXPECT_LT(pelvis.lagged_rms_m, 0.8 * pelvis.rms_m) << pelvis.rms_m;

  config.lag_s = 0.0;
  EXPECT_EQ(RunPositions(simulator, config, 12.0, 10.0).at(kPelvisOfOne).lagged_count, 0);
}

TEST(MarkerTrackTest, WithoutOrientationOrMarkersThereIsNoPosition) {
  MarkerTrack track({});
  sensing::MargSample sample;
  sample.accel_m_s2.z() = 9.81F;
  for (int i = 1; i < 300; ++i) {
    sample.measured_at = TimeFromNanoseconds(i * 10'000'000LL);
    std::optional<Eigen::Quaterniond> q;
    if (i > 100) {
      q = Eigen::Quaterniond::Identity();
    }
    EXPECT_FALSE(track.Update(sample, q));
  }
}

}  // namespace
}  // namespace limbcast::fusion
