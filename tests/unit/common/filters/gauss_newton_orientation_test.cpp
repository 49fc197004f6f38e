#include "common/filters/gauss_newton_orientation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "common/filters/gauss_newton_step.hpp"
#include "common/math/rotation.hpp"
#include "tests/unit/common/filters/marg_stream.hpp"

namespace limbcast::filters {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using test_support::MargStream;
using test_support::MargStreamConfig;

constexpr double kDeg = std::numbers::pi / 180.0;

double ErrorOf(const OrientationFilter& filter, const MargStream& stream) {
  return math::AngleBetween_rad(filter.estimate().q_earth_sensor, stream.q_earth_sensor());
}

void Feed(OrientationFilter& filter, MargStream& stream, double seconds,
          std::uint32_t extra_flags = 0) {
  const double end_s = stream.time_s() + seconds - 1e-9;
  while (stream.time_s() < end_s) {
    auto sample = stream.Next();
    sample.flags |= extra_flags;
    (void)filter.Update(sample);
  }
}

TEST(GaussNewtonOrientationTest, TracksCleanMotionExactly) {
  for (const double rate_hz : {25.0, 100.0, 285.714, 1000.0}) {
    MargStream stream(
        {.rate_hz = rate_hz, .rest_s = 3.0, .q_start = math::ExpSO3({1.0, 2.0, 0.5})});
    GaussNewtonOrientation<double> filter({.integration = RateIntegration::kExponential});
    Feed(filter, stream, 33.0);
    EXPECT_LT(ErrorOf(filter, stream), 1e-3 * kDeg) << rate_hz;
  }
}

TEST(GaussNewtonOrientationTest, EulerStepsUnderRotateAsComputed) {
  // One step of θ loses θ − 2·atan(θ/2) ≈ θ³/12; without feedback (tiny k) it adds up.
  const double theta_rad = 0.1;
  GaussNewtonOrientation<double> filter({.integration = RateIntegration::kEuler,
                                         .k_per_s = 1e-9,
                                         .null_time_s = 0.0,
                                         .init_time_s = 0.0});
  sensing::MargSample sample;
  sample.accel_m_s2 = {0.0F, 0.0F, 9.81F};
  sample.mag_tesla = {0.0F, 20e-6F, -40e-6F};
  sample.measured_at = TimeFromNanoseconds(1);
  ASSERT_EQ(filter.Update(sample), SampleVerdict::kFused);
  sample.gyro_rad_s = {0.0F, 0.0F, static_cast<float>(theta_rad / 0.01)};
  constexpr int kSteps = 20;
  for (int i = 0; i < kSteps; ++i) {
    sample.measured_at += std::chrono::milliseconds(10);
    ASSERT_EQ(filter.Update(sample), SampleVerdict::kFused);
  }
  EXPECT_NEAR(math::Heading_rad(filter.estimate().q_earth_sensor),
              kSteps * 2.0 * std::atan(0.5 * theta_rad), 1e-7);
}

TEST(GaussNewtonOrientationTest, BothFormsGiveTheSameTrack) {
  const MargStreamConfig motion{.rest_s = 3.0,
                                .accel_rms_m_s2 = 2.0,
                                .gyro_noise_rad_s = 0.002,
                                .accel_noise_m_s2 = 0.05,
                                .mag_noise_tesla = 5e-7};
  for (const double rho : {0.2, 0.45, 1.0}) {
    MargStream stream(motion);
    GaussNewtonOrientation<double> reduced({.rho = rho});
    GaussNewtonOrientation<double> full({.form = GaussNewtonForm::kFull4x4, .rho = rho});
    double worst_rad = 0.0;
    for (int i = 0; i < 3000; ++i) {
      const auto sample = stream.Next();
      (void)reduced.Update(sample);
      (void)full.Update(sample);
      worst_rad = std::max(worst_rad, math::AngleBetween_rad(reduced.estimate().q_earth_sensor,
                                                             full.estimate().q_earth_sensor));
    }
    EXPECT_LT(worst_rad, 0.1 * kDeg) << rho;  // second order in errors of a few degrees
  }
}

// The published equations literally, in NED with h = −a/|a|, and the filter in ENU.
TEST(GaussNewtonOrientationTest, EqualsThePublishedMathematicsInNed) {
  MargStream stream({.accel_rms_m_s2 = 1.0, .gyro_noise_rad_s = 0.01, .mag_noise_tesla = 1e-6});
  const double k_per_s = 0.7;
  const double rho = 0.8;
  GaussNewtonOrientation<double> filter({.integration = RateIntegration::kEuler,
                                         .k_per_s = k_per_s,
                                         .rho = rho,
                                         .null_time_s = 0.0,
                                         .init_time_s = 0.0});
  const Quaterniond q_EN(0.0, std::sqrt(0.5), std::sqrt(0.5), 0.0);
  Quaterniond q_ned;
  Vector3d n;
  double worst_rad = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const auto sample = stream.Next();
    ASSERT_EQ(filter.Update(sample), SampleVerdict::kFused);
    const Vector3d h0 = -sample.accel_m_s2.cast<double>().normalized();
    const Vector3d b0 = sample.mag_tesla.cast<double>().normalized();
    if (i == 0) {
      Eigen::Matrix3d R_ned;
      R_ned.row(2) = h0;
      R_ned.row(1) = h0.cross(b0).normalized();
      R_ned.row(0) = R_ned.row(1).cross(R_ned.row(2));
      q_ned = math::QuaternionFromMatrix(R_ned);
      const Vector3d b_ned = q_ned * b0;
      n = Vector3d(std::hypot(b_ned.x(), b_ned.y()), 0.0, b_ned.z());
      continue;
    }
    const double dt_s = 0.01;
    const Vector3d half_angle = 0.5 * dt_s * sample.gyro_rad_s.cast<double>();
    q_ned = (q_ned * Quaterniond(1.0, half_angle.x(), half_angle.y(), half_angle.z())).normalized();
    const Vector3d h = q_ned.conjugate() * Vector3d::UnitZ();
    const Vector3d b = q_ned.conjugate() * n;
    const Vector3d dv = k_per_s * dt_s * ReducedStep(h, b, h0, b0, rho);
    q_ned = (q_ned * Quaterniond(1.0, dv.x(), dv.y(), dv.z())).normalized();
    worst_rad =
        std::max(worst_rad, math::AngleBetween_rad(filter.estimate().q_earth_sensor, q_EN * q_ned));
  }
  EXPECT_LT(worst_rad, 1e-9);
}

TEST(GaussNewtonOrientationTest, NullIsTheMeanAtRestAndIsNotTakenInMotion) {
  const Vector3d bias_rad_s(0.01, -0.02, 0.015);
  MargStream at_rest({.rest_s = 10.0, .gyro_bias_rad_s = bias_rad_s});
  GaussNewtonOrientation<double> calibrated({});
  Feed(calibrated, at_rest, 3.0);
  EXPECT_LT((calibrated.estimate().gyro_bias_rad_s - bias_rad_s).norm(), 1e-6);
  EXPECT_TRUE(calibrated.estimate().at_rest);

  MargStream moving({.gyro_bias_rad_s = bias_rad_s});
  GaussNewtonOrientation<double> uncalibrated({});
  Feed(uncalibrated, moving, 20.0);
  EXPECT_EQ(uncalibrated.estimate().gyro_bias_rad_s, Vector3d::Zero());
}

TEST(GaussNewtonOrientationTest, AWrongStartDecaysWithTheGain) {
  // A bias b leaves the tilt error b/k; here its approach: e(t) = (b/k)(1 − exp(−k t)).
  const double k_per_s = 0.5;
  const double bias_rad_s = 0.01;
  MargStream stream({.rate_rms_rad_s = 0.0, .gyro_bias_rad_s = Vector3d(bias_rad_s, 0.0, 0.0)});
  GaussNewtonOrientation<double> filter(
      {.k_per_s = k_per_s, .rho = 1.0, .null_time_s = 0.0, .init_time_s = 0.0});
  Feed(filter, stream, 2.0);
  EXPECT_NEAR(ErrorOf(filter, stream), bias_rad_s / k_per_s * (1.0 - std::exp(-k_per_s * 2.0)),
              2e-4);
  Feed(filter, stream, 18.0);
  EXPECT_NEAR(ErrorOf(filter, stream), bias_rad_s / k_per_s, 2e-4);
}

// [B]: static drift over an hour with k = 1 and ρ = 1 about 1 % of the quaternion components.
TEST(GaussNewtonOrientationTest, StaticDriftIsSmallerThanPublished) {
  MargStream stream({.rate_hz = 25.0,
                     .rate_rms_rad_s = 0.0,
                     .q_start = math::ExpSO3({0.3, -0.5, 1.0}),
                     .gyro_bias_rad_s = Vector3d(0.003, -0.003, 0.002),
                     .gyro_noise_rad_s = 0.01,
                     .accel_noise_m_s2 = 0.05,
                     .mag_noise_tesla = 5e-7});
  GaussNewtonOrientation<double> filter({.k_per_s = 1.0, .rho = 1.0});
  Feed(filter, stream, 3600.0);
  EXPECT_LT(ErrorOf(filter, stream), 0.02);  // 1 % of the components is 0.02 rad
}

// [B]: better than 1° on a tilt table at 10–30 °/s.
TEST(GaussNewtonOrientationTest, TiltTableErrorIsBelowOneDegree) {
  MargStream stream({.rest_s = 3.0,
                     .rate_rms_rad_s = 20.0 * kDeg,
                     .gyro_bias_rad_s = Vector3d(0.01, 0.01, -0.01),
                     .gyro_noise_rad_s = 0.005,
                     .accel_noise_m_s2 = 0.1,
                     .mag_noise_tesla = 5e-7});
  GaussNewtonOrientation<double> filter({.k_per_s = 1.0, .rho = 1.0});
  Feed(filter, stream, 3.0);
  double worst_rad = 0.0;
  for (int i = 0; i < 6000; ++i) {
    (void)filter.Update(stream.Next());
    worst_rad = std::max(worst_rad, ErrorOf(filter, stream));
  }
  EXPECT_LT(worst_rad, 1.0 * kDeg);
}

TEST(GaussNewtonOrientationTest, WorksWithoutGyroFromAccelerometerAndMagnetometer) {
  MargStream stream({.q_start = math::ExpSO3({0.4, 0.1, -2.0})});
  GaussNewtonOrientation<double> filter({});
  Feed(filter, stream, 10.0, sensing::kGyroMissing);
  EXPECT_TRUE(filter.estimate().started);
  EXPECT_FALSE(filter.estimate().degraded);  // it never had one
  EXPECT_LT(ErrorOf(filter, stream), 0.1 * kDeg);
}

TEST(GaussNewtonOrientationTest, WithoutMagnetometerTiltIsKeptAndHeadingIsFree) {
  MargStream stream({.rest_s = 3.0});
  GaussNewtonOrientation<double> filter({});
  Feed(filter, stream, 30.0, sensing::kMagMissing);
  EXPECT_EQ(filter.estimate().heading, HeadingReference::kArbitrary);
  EXPECT_EQ(filter.estimate().magnetic_state, MagneticState::kUnused);
  EXPECT_LT((filter.estimate().q_earth_sensor.conjugate() * Vector3d::UnitZ() -
             stream.q_earth_sensor().conjugate() * Vector3d::UnitZ())
                .norm(),
            0.01 * kDeg);
}

TEST(GaussNewtonOrientationTest, EquivalentCovarianceSettlesAndGrowsWithoutReference) {
  MargStream stream({.rest_s = 3.0});
  GaussNewtonOrientation<double> filter({});
  Feed(filter, stream, 60.0);
  const Eigen::Matrix3d settled = filter.estimate().cov_orientation_rad2;
  EXPECT_NEAR(std::sqrt(settled(0, 0)), 1.6 * kDeg, 0.3 * kDeg);
  EXPECT_NEAR(std::sqrt(settled(2, 2)), 3.0 * kDeg, 0.5 * kDeg);
  Feed(filter, stream, 10.0, sensing::kMagMissing);
  EXPECT_GT(filter.estimate().cov_orientation_rad2(2, 2), settled(2, 2));
}

// Noise, a moving limb, and readings that are missing or not numbers.
sensing::MargSample NextOfAHardStream(MargStream& stream, int i) {
  auto sample = stream.Next();
  if (i % 211 == 0) {
    sample.gyro_rad_s.y() = NAN;
  }
  if (i % 317 < 2) {
    sample.accel_m_s2.x() = INFINITY;
  }
  if (i % 2'300 < 12) {
    sample.flags |= sensing::kGyroMissing;  // too long to hold
  }
  if (i % 3'100 < 300) {
    sample.mag_tesla.setZero();
  }
  return sample;
}
const MargStreamConfig kHard{.rest_s = 3.0,
                             .accel_rms_m_s2 = 2.0,
                             .gyro_bias_rad_s = Vector3d(0.01, -0.005, 0.002),
                             .gyro_noise_rad_s = 0.002,
                             .accel_noise_m_s2 = 0.05,
                             .mag_noise_tesla = 5e-7};

TEST(GaussNewtonOrientationTest, SinglePrecisionFollowsDouble) {
  MargStream stream(kHard);
  GaussNewtonOrientation<double> wide({});
  GaussNewtonOrientation<float> narrow({});
  for (int i = 0; i < 60'000; ++i) {  // ten minutes
    const auto sample = NextOfAHardStream(stream, i);
    ASSERT_EQ(narrow.Update(sample), wide.Update(sample)) << i;
    ASSERT_EQ(narrow.estimate().started, wide.estimate().started);
    ASSERT_EQ(narrow.estimate().degraded, wide.estimate().degraded);
    ASSERT_EQ(narrow.estimate().heading, wide.estimate().heading);
    ASSERT_LT(math::AngleBetween_rad(narrow.estimate().q_earth_sensor.normalized(),
                                     wide.estimate().q_earth_sensor),
              0.01 * kDeg)
        << i;
    ASSERT_NEAR(narrow.estimate().q_earth_sensor.norm(), 1.0, 1e-6) << i;
  }
}

// The integration leaves the length as rounding makes it: so it must not creep while nothing pulls.
TEST(GaussNewtonOrientationTest, LengthStaysOneWithoutAccelerometer) {
  MargStream stream({.rest_s = 3.0, .rate_rms_rad_s = 8.0});
  GaussNewtonOrientation<double> wide({});
  GaussNewtonOrientation<float> narrow({});
  for (int i = 0; i < 60'000; ++i) {
    auto sample = stream.Next();
    if (i > 500) {
      sample.flags |= sensing::kAccelMissing;
    }
    static_cast<void>(wide.Update(sample));
    static_cast<void>(narrow.Update(sample));
  }
  EXPECT_NEAR(wide.estimate().q_earth_sensor.norm(), 1.0, 1e-14);
  EXPECT_NEAR(narrow.estimate().q_earth_sensor.norm(), 1.0, 1e-6);
}

TEST(GaussNewtonOrientationTest, ASinglePrecisionStateContinuesBitForBitAndOnlyThere) {
  MargStream stream(kHard);
  GaussNewtonOrientation<float> filter({});
  for (int i = 0; i < 1'000; ++i) {
    static_cast<void>(filter.Update(NextOfAHardStream(stream, i)));
  }
  std::vector<std::byte> bytes(filter.state_size_bytes());
  filter.SaveState(bytes);
  GaussNewtonOrientation<float> other({});
  ASSERT_TRUE(other.RestoreState(bytes).ok());
  for (int i = 1'000; i < 4'000; ++i) {
    const auto sample = NextOfAHardStream(stream, i);
    ASSERT_EQ(filter.Update(sample), other.Update(sample));
    ASSERT_TRUE(filter.estimate().q_earth_sensor.coeffs() ==
                other.estimate().q_earth_sensor.coeffs());
    ASSERT_TRUE(filter.estimate().cov_orientation_rad2 == other.estimate().cov_orientation_rad2);
  }
  GaussNewtonOrientation<double> wide({});
  EXPECT_FALSE(wide.RestoreState(bytes).ok());
}

TEST(GaussNewtonOrientationTest, ThePrecisionIsTheOneAskedFor) {
  const auto wide = MakeGaussNewtonOrientation({});
  const auto narrow = MakeGaussNewtonOrientation({.precision = Precision::kFloat});
  EXPECT_NE(dynamic_cast<GaussNewtonOrientation<double>*>(wide.get()), nullptr);
  EXPECT_NE(dynamic_cast<GaussNewtonOrientation<float>*>(narrow.get()), nullptr);
}

TEST(GaussNewtonConfigTest, ValidateNamesFieldValueAndRange) {
  EXPECT_TRUE(Validate(GaussNewtonConfig{}).ok());
  const Status bad = Validate(GaussNewtonConfig{.rho = -1.0});
  ASSERT_FALSE(bad.ok());
  EXPECT_EQ(bad.error().message, "tqt.rho must be in [0, 10], is -1");
  EXPECT_FALSE(Validate(GaussNewtonConfig{.k_per_s = NAN}).ok());
  EXPECT_FALSE(Validate(GaussNewtonConfig{.iterations = 0}).ok());
}

}  // namespace
}  // namespace limbcast::filters
