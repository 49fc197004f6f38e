#include "common/simulation/arm_motion.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "common/math/rotation.hpp"

namespace limbcast::simulation {
namespace {

using Eigen::Vector3d;

constexpr double kQuarter_rad = 0.5 * std::numbers::pi;

TEST(ArmMotionTest, StraightArmLiesAlongX) {
  const RigidMotion wrist = WristOf({.upper_m = 0.3, .fore_m = 0.25}, {0.0, 0.0, 1.4}, {});
  EXPECT_LT((wrist.p_earth_local_m - Vector3d(0.55, 0.0, 1.4)).norm(), 1e-12);
  EXPECT_LT((wrist.R_earth_local - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

TEST(ArmMotionTest, FlexionLiftsAbductionSpreadsAndTheElbowBendsUpwards) {
  const Arm arm{.upper_m = 0.3, .fore_m = 0.25};
  const Jet3 shoulder{0.0, 0.0, 1.4};
  const auto wrist_m = [&](const ArmAngles& angles) {
    return WristOf(arm, shoulder, angles).p_earth_local_m;
  };
  EXPECT_LT((wrist_m({.heading = {}, .flexion = -kQuarter_rad}) - Vector3d(0.0, 0.0, 0.85)).norm(),
            1e-12);
  EXPECT_LT((wrist_m({.abduction = kQuarter_rad}) - Vector3d(0.0, -0.55, 1.4)).norm(), 1e-12);
  EXPECT_LT((wrist_m({.elbow = kQuarter_rad}) - Vector3d(0.3, 0.0, 1.65)).norm(), 1e-12);
  EXPECT_LT((wrist_m({.heading = kQuarter_rad}) - Vector3d(0.0, 0.55, 1.4)).norm(), 1e-12);
  // A hanging arm is spread to the right of a person that faces x.
  EXPECT_LT(
      (wrist_m({.flexion = -kQuarter_rad, .abduction = kQuarter_rad}) - Vector3d(0.0, -0.55, 1.4))
          .norm(),
      1e-12);
}

TEST(ArmMotionTest, RatesAndAccelerationsBelongToTheMotion) {
  const auto at = [](double t_s) {
    const Jet t = Jet::Variable(t_s);
    return WristOf({}, {0.1 * t, Sin(t), 1.4},
                   {.heading = 0.3 * t,
                    .flexion = Sin(2.0 * t),
                    .abduction = Cos(3.0 * t),
                    .elbow = Sin(1.7 * t + 1.0),
                    .pronation = 0.8 * Sin(4.0 * t)});
  };
  constexpr double kStep_s = 1e-4;
  for (const double t_s : {0.3, 1.1, 2.7}) {
    const RigidMotion before = at(t_s - kStep_s);
    const RigidMotion now = at(t_s);
    const RigidMotion after = at(t_s + kStep_s);
    const Vector3d a_m_s2 =
        (after.p_earth_local_m - 2.0 * now.p_earth_local_m + before.p_earth_local_m) /
        (kStep_s * kStep_s);
    EXPECT_LT((a_m_s2 - now.a_earth_local_m_s2).norm(), 1e-4 * now.a_earth_local_m_s2.norm());
    const Vector3d turned_rad = math::LogSO3(
        math::QuaternionFromMatrix(after.R_earth_local * before.R_earth_local.transpose()));
    EXPECT_LT((turned_rad / (2.0 * kStep_s) - now.w_earth_local_rad_s).norm(), 1e-5);
  }
}

}  // namespace
}  // namespace limbcast::simulation
