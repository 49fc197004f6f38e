#include "common/filters/attitude_watchdog.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/filters/filter_constants.hpp"
#include "common/math/rotation.hpp"

namespace limbcast::filters {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kDeg = std::numbers::pi / 180.0;
constexpr double kField_tesla = 48e-6;
const Vector3d kReference(0.0, std::cos(67.0 * kDeg), -std::sin(67.0 * kDeg));

// What a sensor with the true attitude `q_true` reads; 100 Hz.
GatedSample Reading(const Quaterniond& q_true, const Vector3d& accel_E = Vector3d::Zero()) {
  GatedSample sample;
  sample.verdict = SampleVerdict::kFused;
  sample.dt_s = 0.01;
  sample.accel_valid = true;
  sample.accel_m_s2 = q_true.conjugate() * (Vector3d(0.0, 0.0, kGravity_m_s2) + accel_E);
  sample.mag_valid = true;
  sample.mag_tesla = kField_tesla * (q_true.conjugate() * kReference);
  return sample;
}

AttitudeLoss Update(AttitudeWatchdog& watchdog, const GatedSample& sample,
                    const Quaterniond& q_estimated) {
  const Vector3d free_m_s2 = q_estimated * sample.accel_m_s2 - Vector3d(0.0, 0.0, kGravity_m_s2);
  return watchdog.Add(sample, free_m_s2)
             ? watchdog.Look(sample, q_estimated, kReference, 1.0 / kField_tesla)
             : AttitudeLoss::kNone;
}

// Seconds until the loss is reported, or a negative number when it is not within `most_s`.
struct Outcome {
  AttitudeLoss loss = AttitudeLoss::kNone;
  double after_s = -1.0;
};
Outcome Watch(const Quaterniond& q_error, double most_s, bool with_mag = true) {
  AttitudeWatchdog watchdog;
  for (int i = 1; i <= static_cast<int>(100 * most_s); ++i) {
    const Quaterniond q_true = math::ExpSO3({0.3 * std::sin(0.02 * i), 0.02 * i, 0.0});
    GatedSample sample = Reading(q_true, {20.0 * std::sin(0.05 * i), 20.0 * std::cos(0.06 * i),
                                          30.0 * std::sin(0.6283 * i)});
    sample.mag_valid = with_mag;
    const AttitudeLoss loss = Update(watchdog, sample, q_error * q_true);
    if (loss != AttitudeLoss::kNone) {
      return {loss, 0.01 * i};
    }
  }
  return {};
}

TEST(AttitudeWatchdogTest, LeavesARightAttitudeAloneInFastMotion) {
  EXPECT_EQ(Watch(Quaterniond::Identity(), 600.0).loss, AttitudeLoss::kNone);
}

TEST(AttitudeWatchdogTest, LeavesTheErrorsOfAHealthyFilterAlone) {
  EXPECT_EQ(Watch(math::ExpSO3({10.0 * kDeg, 0.0, 0.0}), 600.0).loss, AttitudeLoss::kNone);
  EXPECT_EQ(Watch(math::ExpSO3({0.0, 0.0, 10.0 * kDeg}), 600.0).loss, AttitudeLoss::kNone);
}

TEST(AttitudeWatchdogTest, ReportsATiltedAttitudeWithinSevenSeconds) {
  for (const double tilt_deg : {40.0, 90.0, 180.0}) {
    const Outcome outcome = Watch(math::ExpSO3({tilt_deg * kDeg, 0.0, 0.0}), 60.0);
    EXPECT_EQ(outcome.loss, AttitudeLoss::kTilt) << tilt_deg;
    // 4 s beyond the limit, which the 3 s mean crosses after 3·ln(1/(1 − 0.35/|1 − e^{jφ}|)), 2.2 s
    // for 40°; what is left of the shaking in the mean (0.1 g) delays that by up to 0.5 s.
    EXPECT_LT(outcome.after_s, 6.7) << tilt_deg;
  }
}

TEST(AttitudeWatchdogTest, ReportsATurnedHeadingOnceTheFieldHasBeenCleanForTwelveSeconds) {
  for (const double turn_deg : {-170.0, -25.0, 25.0, 90.0}) {
    const Outcome outcome = Watch(math::ExpSO3({0.0, 0.0, turn_deg * kDeg}), 60.0);
    EXPECT_EQ(outcome.loss, AttitudeLoss::kHeading) << turn_deg;
    EXPECT_NEAR(outcome.after_s, 12.0, 0.2) << turn_deg;
  }
}

TEST(AttitudeWatchdogTest, WithoutMagnetometerHeadingIsNobodysBusiness) {
  EXPECT_EQ(Watch(math::ExpSO3({0.0, 0.0, 1.5}), 100.0, false).loss, AttitudeLoss::kNone);
}

TEST(AttitudeWatchdogTest, ADisturbedFieldNeverAccuses) {
  AttitudeWatchdog watchdog;
  for (int i = 0; i < 60'000; ++i) {
    GatedSample sample = Reading(Quaterniond::Identity());
    sample.mag_tesla +=
        Vector3d(0.3, 0.1, 0.15) * kField_tesla;  // norm and dip are off, heading, too
    ASSERT_EQ(Update(watchdog, sample, Quaterniond::Identity()), AttitudeLoss::kNone);
  }
}

TEST(AttitudeWatchdogTest, AnAbsurdReadingIsForgotten) {
  AttitudeWatchdog watchdog;
  GatedSample absurd = Reading(Quaterniond::Identity());
  absurd.accel_m_s2 *= -15.0;
  absurd.dt_s = 0.05;
  (void)Update(watchdog, absurd, Quaterniond::Identity());
  for (int i = 0; i < 6'000; ++i) {
    ASSERT_EQ(Update(watchdog, Reading(Quaterniond::Identity()), Quaterniond::Identity()),
              AttitudeLoss::kNone);
  }
}

TEST(AttitudeWatchdogTest, MissingChannelsSayNothing) {
  AttitudeWatchdog watchdog;
  for (int i = 0; i < 6'000; ++i) {
    GatedSample sample = Reading(Quaterniond::Identity());
    sample.accel_valid = false;
    sample.mag_valid = false;
    ASSERT_EQ(Update(watchdog, sample, math::ExpSO3({2.0, 0.0, 0.0})), AttitudeLoss::kNone);
  }
}

}  // namespace
}  // namespace limbcast::filters
