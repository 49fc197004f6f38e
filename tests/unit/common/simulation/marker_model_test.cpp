#include "common/simulation/marker_model.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace limbcast::simulation {
namespace {

constexpr double kFrame_s = 0.01;
const std::array<Eigen::Vector3d, 2> kPlaces_m = {Eigen::Vector3d(1.0, 2.0, 3.0),
                                                  Eigen::Vector3d(4.0, 5.0, 6.0)};

TEST(MarkerModelTest, WithoutErrorsTheMarkersAreWhereTheyAre) {
  MarkerModel model({.sigma_m = 0.0}, 2, Random(1));
  const auto seen = model.See(kPlaces_m, kFrame_s);
  EXPECT_EQ(seen[0].p_earth_marker_m, kPlaces_m[0]);
  EXPECT_EQ(seen[1].p_earth_marker_m, kPlaces_m[1]);
  EXPECT_TRUE(seen[0].visible && seen[1].visible);
}

TEST(MarkerModelTest, NoiseHasTheSizeThatIsStated) {
  MarkerModel model({.sigma_m = 0.5e-3}, 2, Random(2));
  double sum_m2 = 0.0;
  constexpr int kFrames = 20'000;
  for (int i = 0; i < kFrames; ++i) {
    sum_m2 += (model.See(kPlaces_m, kFrame_s)[0].p_earth_marker_m - kPlaces_m[0]).squaredNorm();
  }
  EXPECT_NEAR(std::sqrt(sum_m2 / (3.0 * kFrames)), 0.5e-3, 1e-5);
}

TEST(MarkerModelTest, AMarkerIsHiddenForThePartOfTimeThatRateAndLengthGive) {
  // Gaps of 0.5 s that begin 0.4 times a second of visible time: hidden 0.2 of 1.2.
  MarkerModel model({.gap_rate_hz = 0.4, .gap_s = 0.5}, 2, Random(3));
  int hidden = 0;
  constexpr int kFrames = 200'000;
  for (int i = 0; i < kFrames; ++i) {
    hidden += model.See(kPlaces_m, kFrame_s)[1].visible ? 0 : 1;
  }
  EXPECT_NEAR(hidden / static_cast<double>(kFrames), 1.0 / 6.0, 0.015);
}

TEST(MarkerModelTest, GhostsAreAsOftenAndAsNearAsStated) {
  MarkerModel model({.sigma_m = 0.0, .ghost_rate = 0.1, .ghost_distance_m = 0.3}, 2, Random(4));
  int ghosts = 0;
  constexpr int kFrames = 20'000;
  for (int i = 0; i < kFrames; ++i) {
    const Eigen::Vector3d off_m = model.See(kPlaces_m, kFrame_s)[0].p_earth_marker_m - kPlaces_m[0];
    ghosts += off_m.norm() > 0.0 ? 1 : 0;
    EXPECT_LE(off_m.cwiseAbs().maxCoeff(), 0.3);
  }
  EXPECT_NEAR(ghosts, 2000, 150);
}

TEST(MarkerModelTest, SwappedMarkersBearEachOthersNames) {
  MarkerModel model({.sigma_m = 0.0, .swap_rate_hz = 1.0, .swap_s = 0.2}, 2, Random(5));
  int swapped = 0;
  for (int i = 0; i < 10'000; ++i) {
    const auto seen = model.See(kPlaces_m, kFrame_s);
    const bool now = seen[0].p_earth_marker_m == kPlaces_m[1];
    EXPECT_EQ(seen[1].p_earth_marker_m, kPlaces_m[now ? 0 : 1]);
    swapped += now ? 1 : 0;
  }
  EXPECT_NEAR(swapped / 10'000.0, 0.2 / 1.2, 0.05);
}

TEST(MarkerModelTest, ARangeThatIsNotKeptIsNamed) {
  const Status status = Validate(MarkerErrors{.ghost_rate = 1.5});
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().message.find("ghost_rate must be in [0"), std::string::npos);
}

}  // namespace
}  // namespace limbcast::simulation
