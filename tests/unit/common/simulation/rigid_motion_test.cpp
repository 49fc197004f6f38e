#include "common/simulation/rigid_motion.hpp"

#include <gtest/gtest.h>

#include "common/math/rotation.hpp"

namespace limbcast::simulation {
namespace {

// Some chain of moving joints with offsets between them.
RigidMotion Chain(double t_s) {
  const Jet t = Jet::Variable(t_s);
  RigidMotion frame = MovingPoint({Sin(t), t * t, Cos(2.0 * t)});
  RotateAbout(frame, 2, 1.0 + 2.0 * t);
  RotateAbout(frame, 1, Sin(3.0 * t));
  frame = AtPoint(frame, {0.3, -0.2, 0.5});
  RotateAbout(frame, 0, Cos(t) * t);
  RotateAbout(frame, 2, -1.5 * Sin(2.0 * t));
  return AtPoint(frame, {-0.1, 0.4, 0.2});
}

void ExpectDerivatives(const RigidMotion& before, const RigidMotion& at, const RigidMotion& after,
                       double step_s) {
  const auto slope = [step_s](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return Eigen::Vector3d((b - a) / (2.0 * step_s));
  };
  const Eigen::Vector3d w_rad_s = math::LogSO3(math::QuaternionFromMatrix(
                                      after.R_earth_local * before.R_earth_local.transpose())) /
                                  (2.0 * step_s);
  EXPECT_LT((w_rad_s - at.w_earth_local_rad_s).norm(), 1e-5);
  EXPECT_LT(
      (slope(before.w_earth_local_rad_s, after.w_earth_local_rad_s) - at.wd_earth_local_rad_s2)
          .norm(),
      1e-4);
  EXPECT_LT((slope(before.p_earth_local_m, after.p_earth_local_m) - at.v_earth_local_m_s).norm(),
            1e-5);
  EXPECT_LT(
      (slope(before.v_earth_local_m_s, after.v_earth_local_m_s) - at.a_earth_local_m_s2).norm(),
      1e-4);
}

TEST(RigidMotionTest, RatesAndAccelerationsAreThoseOfTheMotion) {
  constexpr double kStep_s = 1e-4;
  for (double t_s = 0.0; t_s < 3.0; t_s += 0.37) {
    ExpectDerivatives(Chain(t_s - kStep_s), Chain(t_s), Chain(t_s + kStep_s), kStep_s);
  }
}

TEST(RigidMotionTest, MovingAxesGiveTheSameAsTurning) {
  const Jet angle_rad = Sin(Jet::Variable(0.8));
  RigidMotion turned;
  RotateAbout(turned, 2, angle_rad);
  RigidMotion set;
  const Jet zero;
  SetAxes(set, {Cos(angle_rad), Sin(angle_rad), zero}, {-Sin(angle_rad), Cos(angle_rad), zero},
          {zero, zero, Jet{1.0}});
  EXPECT_LT((turned.R_earth_local - set.R_earth_local).norm(), 1e-15);
  EXPECT_LT((turned.w_earth_local_rad_s - set.w_earth_local_rad_s).norm(), 1e-15);
  EXPECT_LT((turned.wd_earth_local_rad_s2 - set.wd_earth_local_rad_s2).norm(), 1e-15);
}

TEST(RigidMotionTest, RotationIsRightHandedAboutTheOwnAxis) {
  RigidMotion frame;
  RotateAbout(frame, 2, Jet{0.5});
  RotateAbout(frame, 0, Jet{0.25});
  const Eigen::Matrix3d expected = (Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(0.25, Eigen::Vector3d::UnitX()))
                                       .toRotationMatrix();
  EXPECT_LT((frame.R_earth_local - expected).norm(), 1e-15);
}

TEST(RigidMotionTest, OriginGivesBackTheMovingPoint) {
  const Jet3 p_m = Origin(MovingPoint({{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}, {7.0, 8.0, 9.0}}));
  EXPECT_EQ(p_m.y.value, 4.0);
  EXPECT_EQ(p_m.y.rate, 5.0);
  EXPECT_EQ(p_m.z.accel, 9.0);
}

}  // namespace
}  // namespace limbcast::simulation
