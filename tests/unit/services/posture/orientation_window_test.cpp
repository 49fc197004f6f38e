#include "services/posture/orientation_window.hpp"

#include <gtest/gtest.h>

#include "common/math/rotation.hpp"

namespace limbcast::posture {
namespace {

using namespace std::chrono_literals;

constexpr Time kStart = TimeFromNanoseconds(1'000'000'000);

class OrientationWindowTest : public ::testing::TestWithParam<double> {};

TEST_P(OrientationWindowTest, CoversTheSpanAtEveryRateAndForgetsWhatIsOlder) {
  const double rate_hz = GetParam();
  OrientationWindow window(300ms);
  // Two seconds turned, then 0.35 s still: only the still part may count.
  for (int i = 0; i < static_cast<int>(2.35 * rate_hz); ++i) {
    const double t_s = i / rate_hz;
    window.Add(kStart + DurationFromSeconds(t_s), math::ExpSO3({0.0, 0.0, t_s < 2.0 ? t_s : 2.5}));
  }
  const auto average = window.Average();
  ASSERT_TRUE(average.has_value());
  EXPECT_NEAR(math::Heading_rad(average->mean), 2.5, 3e-7);  // kept in single precision
  EXPECT_LT(average->spread_rad, 1e-7);
  EXPECT_GE(average->count, std::min<std::size_t>(10, static_cast<std::size_t>(0.25 * rate_hz)));
}
INSTANTIATE_TEST_SUITE_P(Rates_hz, OrientationWindowTest,
                         ::testing::Values(20.0, 60.0, 100.0, 285.7, 1000.0));

TEST(OrientationWindowTest, SaysNothingBeforeHalfOfTheSpanIsCovered) {
  OrientationWindow window(300ms);
  EXPECT_FALSE(window.Average().has_value());
  window.Add(kStart, Eigen::Quaterniond::Identity());
  window.Add(kStart + 149ms, Eigen::Quaterniond::Identity());
  EXPECT_FALSE(window.Average().has_value());
  window.Add(kStart + 165ms, Eigen::Quaterniond::Identity());
  EXPECT_TRUE(window.Average().has_value());
  window.Clear();
  EXPECT_FALSE(window.Average().has_value());
}

TEST(OrientationWindowTest, TimeThatGoesBackwardsStartsAnew) {
  OrientationWindow window(300ms);
  for (int i = 0; i < 40; ++i) {
    window.Add(kStart + i * 10ms, Eigen::Quaterniond::Identity());
  }
  window.Add(kStart, Eigen::Quaterniond::Identity());
  EXPECT_FALSE(window.Average().has_value());
}

}  // namespace
}  // namespace limbcast::posture
