#include "common/filters/position/known_attitude_start.hpp"

#include <gtest/gtest.h>

#include "common/math/rotation.hpp"
#include "tests/unit/common/filters/position/optical_scene.hpp"

namespace limbcast::filters {
namespace {

using test_support::OpticalScene;
using test_support::OpticalSceneConfig;

OpticalSceneConfig Moving() {
  OpticalSceneConfig config;
  config.rest_s = 0.5;
  config.motion_s = 6.0;
  config.gyro_noise_rad_s = 0.002;
  config.accel_noise_m_s2 = 0.05;
  config.marker_noise_m = 3e-4;
  return config;
}

struct Found {
  std::optional<NavigationState> start = std::nullopt;
  std::size_t row = 0;
};

// From `row` on, with attitudes that are `error_rad` off about earth axes.
Found Search(const OpticalScene& scene, std::size_t row, const Eigen::Vector3d& error_rad) {
  KnownAttitudeStart start(9.81, Eigen::Vector3d::Zero());
  Found found{.row = row};
  const Eigen::Quaterniond off = math::ExpSO3(error_rad);
  for (; found.row < scene.rows() && !found.start; ++found.row) {
    std::optional<TimedMarker> marker;
    if (scene.markers[found.row].visible) {
      marker = TimedMarker{scene.markers[found.row].measured_at,
                           scene.markers[found.row].p_earth_marker_m, 0.0};
    }
    const sensing::MargSample& sample = scene.samples[found.row];
    found.start = start.Add({sample.gyro_rad_s.cast<double>(), sample.accel_m_s2.cast<double>()},
                            0.005, off * scene.truth[found.row].q_earth_sensor, marker);
  }
  --found.row;
  return found;
}

TEST(KnownAttitudeStartTest, FindsPositionAndVelocityInTheMiddleOfAMotion) {
  const OpticalScene scene(Moving());
  for (std::size_t row = 200; row < 1000; row += 100) {
    const Found found = Search(scene, row, {0.02, -0.02, 0.06});
    ASSERT_TRUE(found.start) << row;
    EXPECT_LE(found.row, row + 60) << "a quarter of a second";
    const NavigationState& truth = scene.truth[found.row];
    EXPECT_LT((found.start->p_earth_sensor_m - truth.p_earth_sensor_m).norm(), 0.01) << row;
    EXPECT_LT((found.start->v_earth_sensor_m_s - truth.v_earth_sensor_m_s).norm(), 0.1) << row;
  }
}

TEST(KnownAttitudeStartTest, AGhostSpoilsOneWindowOnly) {
  OpticalScene scene(Moving());
  scene.markers[220].p_earth_marker_m.x() += 0.3;
  const Found found = Search(scene, 200, Eigen::Vector3d::Zero());
  ASSERT_TRUE(found.start);
  EXPECT_GT(found.row, 250U) << "the first window had the ghost";
  EXPECT_LT((found.start->p_earth_sensor_m - scene.truth[found.row].p_earth_sensor_m).norm(), 0.01);
}

TEST(KnownAttitudeStartTest, TooFewMarkersAreNoStart) {
  OpticalScene scene(Moving());
  scene.Hide(200, 1200);
  EXPECT_FALSE(Search(scene, 200, Eigen::Vector3d::Zero()).row < 1200);
}

TEST(KnownAttitudeStartTest, TheFilterStartsFromItAndStays) {
  const OpticalScene scene(Moving());
  OpticalInertialFilter filter({});
  std::size_t started_at = 0;
  for (std::size_t row = 300; row < scene.rows(); ++row) {
    static_cast<void>(filter.AddMarker(scene.markers[row]));
    const OpticalStep step = filter.AddInertial(
        scene.samples[row], math::ExpSO3({0.0, 0.0, 0.08}) * scene.truth[row].q_earth_sensor);
    if (step.restarted) {
      EXPECT_EQ(started_at, 0U) << "starts once";
      started_at = row;
    }
    if (started_at > 0 && row > started_at + 400) {
      // The marker's place and the attitude: how far the marker is from the sensor takes longer to
      // find than this motion.
      const NavigationState& now = filter.state().navigation;
      const Eigen::Vector3d p_earth_marker_m =
          now.p_earth_sensor_m + now.q_earth_sensor * filter.state().p_sensor_marker_m;
      EXPECT_LT((p_earth_marker_m - scene.p_earth_marker_m[row]).norm(), 0.002) << row;
      EXPECT_LT(math::AngleBetween_rad(now.q_earth_sensor, scene.truth[row].q_earth_sensor), 0.03)
          << row;
    }
  }
  EXPECT_GT(started_at, 0U);
  EXPECT_LT(started_at, 300U + 80U);
}

}  // namespace
}  // namespace limbcast::filters
