#include "common/body/motion_record.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/math/rotation.hpp"

namespace limbcast::body {
namespace {

/// A sensor that turns about `axis` as angle(t) = a·sin(ωt), 4 s at 50 Hz.
MotionRecord Swinging(double a_rad, double w_rad_s) {
  MotionRecord record;
  SegmentRecord one;
  for (int i = 0; i < 200; ++i) {
    const double t_s = i / record.rate_hz;
    one.q_earth_sensor.push_back(math::ExpSO3({0.0, a_rad * std::sin(w_rad_s * t_s), 0.0}));
    one.accel_in_earth_m_s2.emplace_back(std::sin(w_rad_s * t_s), 0.0, 0.0);
  }
  record.segments.push_back(one);
  return record;
}

TEST(MotionRecordTest, RatesAndTheirDerivativesAreThoseOfTheOrientation) {
  const double w_rad_s = 6.0;
  const auto motion = Smooth(Swinging(0.5, w_rad_s), 0.12).front();
  for (std::size_t i = 20; i < 180; ++i) {
    const double t_s = static_cast<double>(i) / 50.0;
    // The window takes 2 % of 1 Hz away; the step of the difference less.
    EXPECT_NEAR(motion.w_earth_sensor_in_earth_rad_s[i].y(), 3.0 * std::cos(w_rad_s * t_s), 0.09);
    EXPECT_NEAR(motion.alpha_in_earth_rad_s2[i].y(), -18.0 * std::sin(w_rad_s * t_s), 0.8);
    EXPECT_NEAR(motion.accel_in_earth_m_s2[i].x(), std::sin(w_rad_s * t_s), 0.03);
  }
}

TEST(MotionRecordTest, SmoothingTakesAwayTheShockOfTheHeel) {
  MotionRecord record = Swinging(0.0, 0.0);
  for (std::size_t i = 0; i < 200; i += 2) {
    record.segments[0].accel_in_earth_m_s2[i].z() = 10.0;  // 25 Hz
  }
  const auto motion = Smooth(record, 0.12).front();
  EXPECT_NEAR(motion.accel_in_earth_m_s2[100].z(), 5.0, 0.5);
  EXPECT_NEAR(motion.accel_in_earth_m_s2[101].z(), 5.0, 0.5);
}

TEST(MotionRecordTest, HeadingIsUnwrappedAndCanBeTakenOut) {
  MotionRecord record;
  SegmentRecord one;
  for (int i = 0; i < 200; ++i) {  // two turns, pitched
    one.q_earth_sensor.push_back(math::ExpSO3({0.0, 0.0, 4.0 * std::numbers::pi * i / 200.0}) *
                                 math::ExpSO3({0.3, 0.0, 0.0}));
    one.accel_in_earth_m_s2.push_back(one.q_earth_sensor.back() * Eigen::Vector3d::UnitX());
  }
  record.segments.push_back(one);
  const auto heading_rad = HeadingSince_rad(one.q_earth_sensor.front(), one.q_earth_sensor);
  EXPECT_NEAR(heading_rad.back(), 4.0 * std::numbers::pi * 199.0 / 200.0, 1e-9);
  auto motions = Smooth(record, 0.12);
  TurnBack(heading_rad, motions);
  EXPECT_LT(math::AngleBetween_rad(motions[0].q_earth_sensor[150], one.q_earth_sensor[0]), 1e-9);
  EXPECT_NEAR(motions[0].accel_in_earth_m_s2[150].y(), 0.0, 1e-6);
  Cut(50, 100, motions);
  EXPECT_EQ(motions[0].q_earth_sensor.size(), 50U);
  EXPECT_EQ(motions[0].alpha_in_earth_rad_s2.size(), 50U);
}

TEST(MotionRecordTest, TheMovingMeanIsShorterAtTheEnds) {
  const auto mean = MovingMean({0.0, 3.0, 6.0, 9.0}, 3);
  EXPECT_EQ(mean, (std::vector<double>{1.5, 3.0, 6.0, 7.5}));
}

}  // namespace
}  // namespace limbcast::body
