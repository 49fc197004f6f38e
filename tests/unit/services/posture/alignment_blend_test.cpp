#include "services/posture/alignment_blend.hpp"

#include <gtest/gtest.h>

#include "common/math/rotation.hpp"

namespace limbcast::posture {
namespace {

using namespace std::chrono_literals;

TEST(AlignmentBlendTest, GoesFromTheOldToTheNewWithoutAJumpAtEitherEnd) {
  const Eigen::Quaterniond q_old = math::ExpSO3({0.4, -0.2, 0.9});
  const Eigen::Quaterniond q_new = math::ExpSO3({-0.1, 0.3, 0.2});
  const double whole_rad = math::AngleBetween_rad(q_old, q_new);
  AlignmentBlend blend;
  blend.Start(q_old, q_new, Time{10s}, 400ms);
  double last_rad = 0.0;
  for (int ms = 0; ms <= 400; ++ms) {
    const double now_rad = math::AngleBetween_rad(
        blend.Apply(q_new, Time{10s} + std::chrono::milliseconds(ms)), q_old);
    EXPECT_GE(now_rad, last_rad - 1e-7);
    EXPECT_LE(now_rad - last_rad, 1.5 * whole_rad / 400.0 + 1e-7) << "slope of 3u² − 2u³";
    last_rad = now_rad;
  }
  EXPECT_NEAR(last_rad, whole_rad, 1e-7);
  EXPECT_FALSE(blend.active());
}

TEST(AlignmentBlendTest, FollowsAMovingSegment) {
  AlignmentBlend blend;
  const Eigen::Quaterniond off = math::ExpSO3({0.0, 0.0, 0.5});
  const Eigen::Quaterniond q = math::ExpSO3({0.7, 0.0, 0.0});
  blend.Start(off, Eigen::Quaterniond::Identity(), Time{10s}, 1s);
  EXPECT_NEAR(math::AngleBetween_rad(blend.Apply(q, Time{10s} + 500ms), q), 0.25, 1e-9);
}

TEST(AlignmentBlendTest, AStreamThatBeginsAnewOrNoSpanEndsIt) {
  AlignmentBlend blend;
  const Eigen::Quaterniond q = math::ExpSO3({0.7, 0.0, 0.0});
  blend.Start(Eigen::Quaterniond::Identity(), q, Time{10s}, 1s);
  EXPECT_EQ(blend.Apply(q, Time{2s}).coeffs(), q.coeffs());
  EXPECT_FALSE(blend.active());
  blend.Start(Eigen::Quaterniond::Identity(), q, Time{10s}, 0s);
  EXPECT_EQ(blend.Apply(q, Time{10s}).coeffs(), q.coeffs());
}

}  // namespace
}  // namespace limbcast::posture
