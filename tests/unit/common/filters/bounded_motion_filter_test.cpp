#include "common/filters/bounded_motion_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/math/rotation.hpp"
#include "tests/unit/common/filters/marg_stream.hpp"

namespace limbcast::filters {
namespace {

using test_support::MargStream;
using test_support::MargStreamConfig;

constexpr double kDeg = 3.14159265358979323846 / 180.0;

double HeadingError_rad(const OrientationFilter& filter, const MargStream& stream) {
  return std::abs(
      math::Heading_rad(filter.estimate().q_earth_sensor * stream.q_earth_sensor().conjugate()));
}

// design/orientation.md section 7: a magnet of 0.83 of the field is put on the sensor during
// rotation.
TEST(BoundedMotionFilterTest, ACarriedMagnetSwitchedOnTurnsHeadingByLessThanTwoDegrees) {
  MargStreamConfig config;
  config.rate_hz = 200.0;
  config.rest_s = 5.0;
  config.rate_rms_rad_s = 1.5;
  config.carried_tesla = [](double t) {
    return t > 40.0 ? Eigen::Vector3d(0.5, -0.4, 0.53) * 48e-6 : Eigen::Vector3d::Zero().eval();
  };
  MargStream stream(config);
  BoundedMotionFilter<double> filter{BoundedMotionConfig()};
  double worst_rad = 0.0;
  while (stream.time_s() < 120.0) {
    static_cast<void>(filter.Update(stream.Next()));
    if (stream.time_s() > 1.0) {
      worst_rad = std::max(worst_rad, HeadingError_rad(filter, stream));
    }
  }
  EXPECT_LT(worst_rad, 2.0 * kDeg);
}

double HeadingErrorWithGyroMatrix(double sigma_gyro_matrix_start) {
  MargStreamConfig config;
  config.rate_hz = 200.0;
  config.rest_s = 3.0;
  config.rate_rms_rad_s = 2.5;
  config.gyro_matrix_error = Eigen::Matrix3d::Constant(0.005);
  MargStream stream(config);
  BoundedMotionConfig filter_config;
  filter_config.sigma_gyro_matrix_start = sigma_gyro_matrix_start;
  if (sigma_gyro_matrix_start == 0.0) {
    filter_config.walk_gyro_matrix_rts = 0.0;
  }
  BoundedMotionFilter<double> filter{filter_config};
  double worst_rad = 0.0;
  while (stream.time_s() < 123.0) {
    static_cast<void>(filter.Update(stream.Next()));
    if (stream.time_s() > 1.0) {
      worst_rad = std::max(worst_rad, HeadingError_rad(filter, stream));
    }
  }
  return worst_rad;
}

TEST(BoundedMotionFilterTest, LearnsTheGyroMatrixAndGainsByIt) {
  const double learned_rad = HeadingErrorWithGyroMatrix(0.005);
  const double frozen_rad = HeadingErrorWithGyroMatrix(0.0);
  EXPECT_LT(learned_rad, 2.5 * kDeg);
  EXPECT_GT(frozen_rad, 1.5 * learned_rad);  // a clean field holds heading by itself, too
}

// The guard: a field that was distorted at the start is noticed when the sensor leaves the spot.
TEST(BoundedMotionFilterTest, ALocalFieldAtTheStartIsForgottenAwayFromIt) {
  MargStreamConfig config;
  config.rate_hz = 200.0;
  config.rest_s = 5.0;
  config.rate_rms_rad_s = 1.0;
  config.mag_noise_tesla = 0.5e-6;
  config.nearby_tesla = [](double t) {
    return t < 15.0 ? Eigen::Vector3d(5e-6, 2e-6, 4e-6) : Eigen::Vector3d::Zero().eval();
  };
  const auto final_error = [&config](const BoundedMotionConfig& filter_config) {
    MargStream stream(config);
    BoundedMotionFilter<double> filter{filter_config};
    double sum = 0.0;
    int count = 0;
    while (stream.time_s() < 180.0) {
      static_cast<void>(filter.Update(stream.Next()));
      if (stream.time_s() > 120.0) {
        sum += HeadingError_rad(filter, stream);
        ++count;
      }
    }
    return sum / count;
  };
  EXPECT_LT(final_error(BoundedMotionConfig()), 2.0 * kDeg);
}

// With the session's field known, a start beside iron is seen at once: heading is in doubt, and
// right soon after the sensor leaves the place.
TEST(BoundedMotionFilterTest, TheSessionsFieldTellsAStartBesideIron) {
  MargStreamConfig config;
  config.rate_hz = 200.0;
  config.rest_s = 5.0;
  config.rate_rms_rad_s = 1.0;
  config.mag_noise_tesla = 0.5e-6;
  config.nearby_tesla = [](double t) {
    return t < 10.0 ? Eigen::Vector3d(4e-6, 1e-6, 2e-6) : Eigen::Vector3d::Zero().eval();
  };
  struct Outcome {
    double at_start_rad = 0.0;
    double sigma_at_start_rad = 0.0;
    double after_rad = 0.0;
  };
  const auto run = [&config](const BoundedMotionConfig& filter_config) {
    MargStream stream(config);
    BoundedMotionFilter<double> filter{filter_config};
    Outcome outcome;
    while (stream.time_s() < 30.0) {
      static_cast<void>(filter.Update(stream.Next()));
      if (stream.time_s() < 1.0) {
        outcome.at_start_rad = HeadingError_rad(filter, stream);
        outcome.sigma_at_start_rad = std::sqrt(filter.estimate().cov_orientation_rad2(2, 2));
      }
    }
    outcome.after_rad = HeadingError_rad(filter, stream);
    return outcome;
  };
  BoundedMotionConfig session;
  session.reference_field_tesla = config.field_tesla;
  session.reference_dip_rad = config.dip_rad;
  const Outcome with = run(session);
  const Outcome without = run(BoundedMotionConfig());
  EXPECT_GT(with.at_start_rad, 10.0 * kDeg);  // nothing tells better at the start
  EXPECT_LT(with.at_start_rad, 2.0 * with.sigma_at_start_rad);
  EXPECT_GT(without.at_start_rad, 2.0 * without.sigma_at_start_rad);
  EXPECT_LT(with.after_rad, 2.0 * kDeg);
  EXPECT_GT(without.after_rad, 5.0 * kDeg);
}

// The guard: a stationary magnet turns the field here and there and leaves length and dip nearly
// alone.
TEST(BoundedMotionFilterTest, AFieldTurnedHereAndThereTurnsHeadingLessThanWithoutTheGuard) {
  MargStreamConfig config;
  config.rate_hz = 200.0;
  config.rest_s = 10.0;
  config.rate_rms_rad_s = 1.5;
  config.gyro_noise_rad_s = 2e-4 * std::sqrt(200.0);
  config.mag_noise_tesla = 0.5e-6;
  config.nearby_tesla = [](double t) {
    const bool there = t > 12.0 && std::fmod(t - 12.0, 20.0) < 8.0;
    return Eigen::Vector3d(there ? 6e-6 : 0.0, 0.0, 0.0);
  };
  const auto rms_rad = [&config](const BoundedMotionConfig& filter_config) {
    MargStream stream(config);
    BoundedMotionFilter<double> filter{filter_config};
    double sum = 0.0;
    int count = 0;
    while (stream.time_s() < 90.0) {
      static_cast<void>(filter.Update(stream.Next()));
      if (stream.time_s() > 12.0) {
        const double error_rad = HeadingError_rad(filter, stream);
        sum += error_rad * error_rad;
        ++count;
      }
    }
    return std::sqrt(sum / count);
  };
  const double guarded_rad = rms_rad(BoundedMotionConfig());
  EXPECT_LT(guarded_rad, 3.0 * kDeg);
  EXPECT_LT(guarded_rad, 0.6 * rms_rad(PlainBoundedMotionConfig()));
}

// A late time stamp turns with the rate: the reported covariance knows, the filter's own does not
// change.
TEST(BoundedMotionFilterTest, TheReportedCovarianceHoldsTheDoubtAboutTime) {
  MargStreamConfig config;
  BoundedMotionConfig with_doubt;
  with_doubt.sigma_time_s = 0.01;
  BoundedMotionConfig without = with_doubt;
  without.sigma_time_s = 0.0;
  MargStream stream(config);
  BoundedMotionFilter<double> doubting{with_doubt};
  BoundedMotionFilter<double> sure{without};
  for (int i = 0; i < 500; ++i) {
    const sensing::MargSample sample = stream.Next();
    static_cast<void>(doubting.Update(sample));
    static_cast<void>(sure.Update(sample));
  }
  const Eigen::Vector3d late_rad =
      0.01 * (sure.estimate().q_earth_sensor * sure.estimate().w_earth_sensor_in_sensor_rad_s);
  const Eigen::Matrix3d more =
      doubting.estimate().cov_orientation_rad2 - sure.estimate().cov_orientation_rad2;
  EXPECT_LT((more - late_rad * late_rad.transpose()).norm(), 1e-12);
  EXPECT_EQ((doubting.core().state().P.Full() - sure.core().state().P.Full()).norm(), 0.0);
}

TEST(BoundedMotionFilterTest, ASavedStateContinuesBitForBit) {
  MargStreamConfig config;
  config.gyro_noise_rad_s = 0.01;
  config.accel_rms_m_s2 = 1.0;
  MargStream stream(config);
  BoundedMotionFilter<float> filter{BoundedMotionConfig()};
  for (int i = 0; i < 1000; ++i) {
    static_cast<void>(filter.Update(stream.Next()));
  }
  std::vector<std::byte> bytes(filter.state_size_bytes());
  filter.SaveState(bytes);
  BoundedMotionFilter<float> other{BoundedMotionConfig()};
  ASSERT_TRUE(other.RestoreState(bytes).ok());
  for (int i = 0; i < 500; ++i) {
    const auto sample = stream.Next();
    ASSERT_EQ(filter.Update(sample), other.Update(sample));
    ASSERT_TRUE(filter.estimate().q_earth_sensor.coeffs() ==
                other.estimate().q_earth_sensor.coeffs());
  }
  bytes[60] ^= std::byte{1};
  EXPECT_FALSE(other.RestoreState(bytes).ok());
}

TEST(BoundedMotionFilterTest, StaysUprightWithoutAMagnetometerAndSaysSo) {
  MargStreamConfig config;
  config.rate_hz = 100.0;
  MargStream stream(config);
  BoundedMotionFilter<double> filter{BoundedMotionConfig()};
  for (int i = 0; i < 6000; ++i) {
    sensing::MargSample sample = stream.Next();
    sample.flags |= sensing::kMagMissing;
    static_cast<void>(filter.Update(sample));
  }
  EXPECT_EQ(filter.estimate().heading, HeadingReference::kArbitrary);
  EXPECT_EQ(filter.estimate().magnetic_state, MagneticState::kUnused);
  const Eigen::Vector3d up_S = stream.q_earth_sensor().conjugate() * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d up_E = filter.estimate().q_earth_sensor * up_S;
  EXPECT_LT(std::acos(std::min(1.0, up_E.z())), 0.5 * kDeg);
}

// The reported covariance means what it says: the mean normalised error over runs stays near its
// dimension. The bound is generous on one side only: a filter may be cautious, but not sure of what
// is wrong.
TEST(BoundedMotionFilterTest, IsNotOverconfidentOnWhatItModels) {
  double nees_sum = 0.0;
  int count = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    MargStreamConfig config;
    config.rate_hz = 100.0;
    config.seed = seed;
    config.rest_s = 3.0;
    config.gyro_noise_rad_s = 2e-4 * std::sqrt(100.0);
    config.accel_noise_m_s2 = 0.01 * std::sqrt(100.0);
    config.mag_noise_tesla = 0.05 * 48e-6;
    config.gyro_bias_rad_s = Eigen::Vector3d(0.003, -0.002, 0.004);
    config.accel_rms_m_s2 = 0.5;
    MargStream stream(config);
    BoundedMotionFilter<double> filter{BoundedMotionConfig()};
    while (stream.time_s() < 40.0) {
      static_cast<void>(filter.Update(stream.Next()));
    }
    const Eigen::Vector3d error =
        math::LogSO3(stream.q_earth_sensor() * filter.estimate().q_earth_sensor.conjugate());
    nees_sum += error.dot(filter.estimate().cov_orientation_rad2.ldlt().solve(error));
    ++count;
  }
  EXPECT_LT(nees_sum / count, 6.0);
  EXPECT_GT(nees_sum / count, 0.05);
}

}  // namespace
}  // namespace limbcast::filters
