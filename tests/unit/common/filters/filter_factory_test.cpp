// What every filter of the factory promises, whatever it computes (common/filters/filter.hpp).
#include "common/filters/filter_factory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "common/math/rotation.hpp"
#include "tests/support/allocation_counter.hpp"
#include "tests/unit/common/filters/marg_stream.hpp"

namespace limbcast::filters {
namespace {

using namespace std::chrono_literals;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using test_support::MargStream;
using test_support::MargStreamConfig;

constexpr double kDeg = std::numbers::pi / 180.0;

const MargStreamConfig kNoisy{.rest_s = 3.0,
                              .accel_rms_m_s2 = 2.0,
                              .gyro_bias_rad_s = Vector3d(0.004, -0.003, 0.002),
                              .gyro_noise_rad_s = 0.002,
                              .accel_noise_m_s2 = 0.05,
                              .mag_noise_tesla = 5e-7};

TEST(FilterFactoryTest, NamesWhatIsWrong) {
  const auto unknown = MakeFilter("kalman");
  ASSERT_FALSE(unknown.ok());
  EXPECT_EQ(unknown.error().code, ErrorCode::kInvalidArgument);
  EXPECT_NE(unknown.error().message.find("is 'kalman'"), std::string::npos);
  const std::vector<Setting> bad = {{"rho", "11"}};
  const auto refused = MakeFilter("tqt", bad);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().message, "tqt.rho must be in [0, 10], is 11");
}

class EveryFilterTest : public ::testing::TestWithParam<std::string_view> {
 protected:
  static std::unique_ptr<OrientationFilter> Make() {
    auto made = MakeFilter(GetParam());
    EXPECT_TRUE(made.ok());
    return std::move(made).value();
  }
};

TEST_P(EveryFilterTest, HasItsNameAndIsNotStarted) {
  const auto filter = Make();
  EXPECT_EQ(filter->name(), GetParam());
  EXPECT_FALSE(filter->estimate().started);
}

TEST_P(EveryFilterTest, UpdateAllocatesNothing) {
  const auto filter = Make();
  MargStream stream(kNoisy);
  std::vector<sensing::MargSample> samples;
  for (int i = 0; i < 2000; ++i) {
    samples.push_back(stream.Next());
  }
  samples[900].gyro_rad_s.setConstant(NAN);
  samples[1000].measured_at += 200ms;
  const std::size_t before = test_support::AllocationCount();
  for (const auto& sample : samples) {
    (void)filter->Update(sample);
  }
  EXPECT_EQ(test_support::AllocationCount(), before);
}

TEST(AllocationCounterTest, SeesAnAllocation) {
  const std::size_t before = test_support::AllocationCount();
  const std::vector<double> some(100);
  EXPECT_EQ(test_support::AllocationCount(), before + 1) << some.size();
}

TEST_P(EveryFilterTest, ASavedStateContinuesBitForBit) {
  const auto original = Make();
  MargStream stream(kNoisy);
  for (int i = 0; i < 1003; ++i) {
    (void)original->Update(stream.Next());
  }
  std::vector<std::byte> saved(original->state_size_bytes());
  original->SaveState(saved);
  const auto restored = Make();
  ASSERT_TRUE(restored->RestoreState(saved).ok());
  for (int i = 0; i < 500; ++i) {
    const auto sample = stream.Next();
    ASSERT_EQ(original->Update(sample), restored->Update(sample));
    ASSERT_EQ(original->estimate().q_earth_sensor.coeffs(),
              restored->estimate().q_earth_sensor.coeffs());
    ASSERT_EQ(original->estimate().cov_orientation_rad2, restored->estimate().cov_orientation_rad2);
  }
}

TEST_P(EveryFilterTest, ADamagedStateIsRefusedAndChangesNothing) {
  const auto filter = Make();
  MargStream stream(kNoisy);
  for (int i = 0; i < 200; ++i) {
    (void)filter->Update(stream.Next());
  }
  const auto before = filter->estimate().q_earth_sensor.coeffs().eval();
  std::vector<std::byte> saved(filter->state_size_bytes());
  filter->SaveState(saved);
  saved[saved.size() / 2] ^= std::byte{1};
  EXPECT_EQ(filter->RestoreState(saved).error().code, ErrorCode::kCorruptData);
  EXPECT_EQ(filter->RestoreState(std::vector<std::byte>(3)).error().code, ErrorCode::kCorruptData);
  EXPECT_EQ(filter->estimate().q_earth_sensor.coeffs(), before);
}

TEST_P(EveryFilterTest, ResetIsLikeNew) {
  const auto used = Make();
  MargStream first(kNoisy);
  for (int i = 0; i < 700; ++i) {
    (void)used->Update(first.Next());
  }
  used->Reset();
  const auto fresh = Make();
  MargStream second(kNoisy);
  for (int i = 0; i < 700; ++i) {
    const auto sample = second.Next();
    (void)used->Update(sample);
    (void)fresh->Update(sample);
  }
  EXPECT_EQ(used->estimate().q_earth_sensor.coeffs(), fresh->estimate().q_earth_sensor.coeffs());
}

TEST_P(EveryFilterTest, TheSignOfTheQuaternionIsContinuous) {
  const auto filter = Make();
  MargStream stream({.rate_rms_rad_s = 5.0});
  Quaterniond last = Quaterniond::Identity();
  for (int i = 0; i < 3000; ++i) {
    (void)filter->Update(stream.Next());
    const Quaterniond now = filter->estimate().q_earth_sensor;
    if (i > 60) {
      ASSERT_GT(now.dot(last), 0.9);
    }
    last = now;
  }
}

// Turning the sensor in its mounting turns the estimate by exactly that, and nothing else.
TEST_P(EveryFilterTest, ASensorMountedOtherwiseGivesTheSameOrientationOfItsCarrier) {
  const Quaterniond q_mount = math::ExpSO3({0.7, -1.9, 0.4});
  const auto straight = Make();
  const auto turned = Make();
  MargStream stream(kNoisy);
  double worst_rad = 0.0;
  for (int i = 0; i < 3000; ++i) {
    auto sample = stream.Next();
    (void)straight->Update(sample);
    const Quaterniond q = q_mount.conjugate();
    sample.gyro_rad_s = (q * sample.gyro_rad_s.cast<double>()).cast<float>();
    sample.accel_m_s2 = (q * sample.accel_m_s2.cast<double>()).cast<float>();
    sample.mag_tesla = (q * sample.mag_tesla.cast<double>()).cast<float>();
    (void)turned->Update(sample);
    worst_rad =
        std::max(worst_rad, math::AngleBetween_rad(turned->estimate().q_earth_sensor,
                                                   straight->estimate().q_earth_sensor * q_mount));
  }
  EXPECT_LT(worst_rad, 1e-3 * kDeg);  // rounding of the turned readings to single precision
}

TEST_P(EveryFilterTest, StartsRightInRandomOrientations) {
  std::mt19937 rng(5);
  std::normal_distribution<double> normal;
  const auto filter = Make();
  for (int trial = 0; trial < 300; ++trial) {
    filter->Reset();
    MargStream stream({.rate_rms_rad_s = 0.0,
                       .q_start = Quaterniond(normal(rng), normal(rng), normal(rng), normal(rng))});
    for (int i = 0; i < 60; ++i) {
      (void)filter->Update(stream.Next());
    }
    ASSERT_TRUE(filter->estimate().started);
    ASSERT_LT(math::AngleBetween_rad(filter->estimate().q_earth_sensor, stream.q_earth_sensor()),
              0.01 * kDeg);
  }
}

TEST_P(EveryFilterTest, LearnsAGyroBiasAtRest) {
  const auto filter = Make();
  MargStreamConfig config = kNoisy;
  config.rest_s = 20.0;
  MargStream stream(config);
  for (int i = 0; i < 2000; ++i) {
    (void)filter->Update(stream.Next());
  }
  // The complementary Kalman filter has no rest detector: it takes longer.
  const bool slow = GetParam().starts_with("ckf");
  EXPECT_LT((filter->estimate().gyro_bias_rad_s - config.gyro_bias_rad_s).norm(),
            slow ? 0.4 * config.gyro_bias_rad_s.norm() : 6e-4);
  EXPECT_LT(math::AngleBetween_rad(filter->estimate().q_earth_sensor, stream.q_earth_sensor()),
            (slow ? 1.5 : 0.5) * kDeg);
}

TEST_P(EveryFilterTest, FreeAccelerationIsWhatIsLeftWithoutGravity) {
  const auto filter = Make();
  MargStream stream({.rest_s = 60.0});
  for (int i = 0; i < 1000; ++i) {
    (void)filter->Update(stream.Next());
  }
  EXPECT_LT(filter->estimate().free_accel_in_earth_m_s2.norm(), 0.01);
}

INSTANTIATE_TEST_SUITE_P(Filters, EveryFilterTest,
                         ::testing::ValuesIn(FilterNames().begin(), FilterNames().end()),
                         [](const auto& test) {
                           std::string name(test.param);
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace limbcast::filters
