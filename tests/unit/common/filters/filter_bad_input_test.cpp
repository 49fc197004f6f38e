// The bad-input table of design/orientation.md section 6, every row for every filter of the
// factory.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "common/filters/complementary_kalman.hpp"
#include "common/filters/filter_factory.hpp"
#include "common/filters/filter_state_codec.hpp"
#include "common/math/rotation.hpp"
#include "tests/unit/common/filters/marg_stream.hpp"

namespace limbcast::filters {
namespace {

using namespace std::chrono_literals;
using Eigen::Vector3d;
using sensing::MargSample;
using test_support::MargStream;

constexpr double kDeg = std::numbers::pi / 180.0;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

bool IsFinite(const FilterEstimate& e) {
  return e.q_earth_sensor.coeffs().allFinite() && e.w_earth_sensor_in_sensor_rad_s.allFinite() &&
         e.free_accel_in_earth_m_s2.allFinite() && e.gyro_bias_rad_s.allFinite() &&
         e.cov_orientation_rad2.allFinite();
}

class FilterBadInputTest : public ::testing::TestWithParam<std::string_view> {
 protected:
  void SetUp() override {
    auto made = MakeFilter(GetParam());
    ASSERT_TRUE(made.ok());
    filter_ = std::move(made).value();
    Feed(6.0);
    ASSERT_TRUE(filter_->estimate().started);
    ASSERT_LT(Error_deg(), 0.5);
  }
  // Feeds the stream; `spoil` may change each sample first.
  template <typename Spoil>
  void Feed(double seconds, Spoil spoil) {
    const double end_s = stream_.time_s() + seconds - 1e-9;
    while (stream_.time_s() < end_s) {
      MargSample sample = stream_.Next();
      spoil(sample);
      last_ = filter_->Update(sample);
      ASSERT_TRUE(IsFinite(filter_->estimate()));
      ASSERT_NEAR(filter_->estimate().q_earth_sensor.norm(), 1.0, 1e-6);
    }
  }
  void Feed(double seconds) {
    Feed(seconds, [](MargSample&) {});
  }
  double Error_deg() const {
    return math::AngleBetween_rad(filter_->estimate().q_earth_sensor, stream_.q_earth_sensor()) /
           kDeg;
  }
  double TiltError_deg() const {
    return std::acos(std::clamp((filter_->estimate().q_earth_sensor.conjugate() * Vector3d::UnitZ())
                                    .dot(stream_.q_earth_sensor().conjugate() * Vector3d::UnitZ()),
                                -1.0, 1.0)) /
           kDeg;
  }
  const FilterEstimate& estimate() const { return filter_->estimate(); }

  MargStream stream_{{.rest_s = 4.0, .rate_rms_rad_s = 1.0}};
  std::unique_ptr<OrientationFilter> filter_;
  SampleVerdict last_ = SampleVerdict::kNoData;
};

TEST_P(FilterBadInputTest, NonFiniteGyroIsBridgedWithTheLastRateForFiftyMilliseconds) {
  Feed(0.05, [](MargSample& s) { s.gyro_rad_s.y() = kNan; });
  EXPECT_TRUE(estimate().degraded);
  EXPECT_GT(estimate().w_earth_sensor_in_sensor_rad_s.norm(), 0.0);
  EXPECT_LT(Error_deg(), 3.0);
  Feed(0.02, [](MargSample& s) { s.gyro_rad_s.y() = kNan; });
  EXPECT_LT(estimate().w_earth_sensor_in_sensor_rad_s.norm(), 0.05);  // not believed any longer
  EXPECT_TRUE(estimate().degraded);
  Feed(0.02);
  EXPECT_FALSE(estimate().degraded);
}

TEST_P(FilterBadInputTest, ALongOutageOfTheGyroLeavesNoTrace) {
  Feed(2.0,
       [](MargSample& s) { s.gyro_rad_s.setConstant(std::numeric_limits<float>::infinity()); });
  EXPECT_TRUE(estimate().degraded);
  Feed(30.0);
  EXPECT_FALSE(estimate().degraded);
  EXPECT_LT(Error_deg(), 6.0);
}

TEST_P(FilterBadInputTest, TimeThatDoesNotAdvanceIsRefusedAndChangesNothing) {
  MargSample sample = stream_.Next();
  ASSERT_EQ(filter_->Update(sample), SampleVerdict::kFused);
  const FilterEstimate before = estimate();
  EXPECT_EQ(filter_->Update(sample), SampleVerdict::kRejectedDuplicate);
  sample.measured_at -= 5ms;
  EXPECT_EQ(filter_->Update(sample), SampleVerdict::kRejectedOutOfOrder);
  EXPECT_EQ(estimate().q_earth_sensor.coeffs(), before.q_earth_sensor.coeffs());
  EXPECT_EQ(estimate().gyro_bias_rad_s, before.gyro_bias_rad_s);
  EXPECT_EQ(estimate().w_earth_sensor_in_sensor_rad_s, before.w_earth_sensor_in_sensor_rad_s);
  EXPECT_EQ(estimate().cov_orientation_rad2, before.cov_orientation_rad2);
}

// Row 3: b_g (and with it S and b_a of bmf, which live in the same state) outlives the restart.
TEST_P(FilterBadInputTest, WhatWasLearnedOfTheGyroOutlivesALongGap) {
  const Vector3d bias_rad_s(0.004, -0.003, 0.002);
  stream_ = MargStream({.rate_rms_rad_s = 0.0, .gyro_bias_rad_s = bias_rad_s});
  filter_->Reset();
  Feed(60.0);
  const Vector3d learned_rad_s = estimate().gyro_bias_rad_s;
  ASSERT_LT((learned_rad_s - bias_rad_s).norm(), 0.4 * bias_rad_s.norm());
  stream_.Skip(20.0);
  Feed(0.01);
  EXPECT_EQ(last_, SampleVerdict::kStarting);
  EXPECT_EQ(estimate().gyro_bias_rad_s, learned_rad_s);
  Feed(1.0);
  EXPECT_EQ(last_, SampleVerdict::kFused);
  EXPECT_LT((estimate().gyro_bias_rad_s - bias_rad_s).norm(), 0.4 * bias_rad_s.norm());
}

TEST_P(FilterBadInputTest, AClockThatWasSetBackIsFollowedAfterAWhile) {
  Feed(1.0, [](MargSample& s) { s.measured_at -= 1h; });
  EXPECT_TRUE(last_ == SampleVerdict::kFused || last_ == SampleVerdict::kPredictedOnly);
  Feed(10.0, [](MargSample& s) { s.measured_at -= 1h; });
  EXPECT_LT(Error_deg(), 5.0);
}

TEST_P(FilterBadInputTest, AShortGapIsBridgedWithTheMeanRateAndWidensTheCovariance) {
  const double before = estimate().cov_orientation_rad2.trace();
  stream_.Skip(0.15);
  // What a sensor would have sampled at the end of the gap: the rate over its last step.
  (void)stream_.Next();
  Feed(0.01);
  EXPECT_TRUE(estimate().started);
  EXPECT_GT(estimate().cov_orientation_rad2.trace(), before + 0.5 * std::pow(0.5 * 0.15, 2));
  EXPECT_LT(Error_deg(), 8.0);
  Feed(20.0);
  EXPECT_LT(Error_deg(), 4.0);
}

TEST_P(FilterBadInputTest, AfterALongGapTheAttitudeStartsAgainFromTheVectors) {
  stream_.Skip(30.0);
  Feed(0.01);
  EXPECT_EQ(last_, SampleVerdict::kStarting);
  EXPECT_TRUE(estimate().started);
  EXPECT_TRUE(estimate().degraded);
  Feed(1.0);
  EXPECT_EQ(last_, SampleVerdict::kFused);
  EXPECT_FALSE(estimate().degraded);
  EXPECT_LT(Error_deg(), 1.0);
}

TEST_P(FilterBadInputTest, FreeFallGivesNoInclination) {
  const double before_deg = Error_deg();
  Feed(0.4, [](MargSample& s) { s.accel_m_s2 = {0.1F, -0.2F, 0.1F}; });
  EXPECT_TRUE(estimate().degraded);
  EXPECT_LT(Error_deg(), before_deg + 0.5);
  Feed(1.0, [](MargSample& s) { s.accel_m_s2.x() = kNan; });
  EXPECT_LT(Error_deg(), before_deg + 1.0);
  Feed(5.0);
  EXPECT_EQ(last_, SampleVerdict::kFused);
  EXPECT_FALSE(estimate().degraded);
  EXPECT_LT(Error_deg(), before_deg + 1.0);
}

TEST_P(FilterBadInputTest, AVanishedMagnetometerLeavesHeadingToTheGyroAndIsTakenBack) {
  Feed(5.0, [](MargSample& s) { s.mag_tesla.setZero(); });
  EXPECT_EQ(estimate().magnetic_state, MagneticState::kUnused);
  EXPECT_TRUE(estimate().degraded);
  EXPECT_LT(Error_deg(), 1.0);
  Feed(6.0, [](MargSample& s) { s.flags |= sensing::kMagMissing; });
  EXPECT_EQ(estimate().heading, HeadingReference::kArbitrary);
  Feed(10.0);
  EXPECT_EQ(estimate().heading, HeadingReference::kMagnetic);
  EXPECT_EQ(estimate().magnetic_state, MagneticState::kClean);
  EXPECT_LT(Error_deg(), 1.0);
}

TEST_P(FilterBadInputTest, WithoutAnyMagnetometerHeadingIsArbitraryFromTheStart) {
  filter_->Reset();
  EXPECT_FALSE(estimate().started);
  Feed(20.0, [](MargSample& s) { s.mag_tesla.setConstant(kNan); });
  EXPECT_TRUE(estimate().started);
  EXPECT_EQ(estimate().heading, HeadingReference::kArbitrary);
  EXPECT_FALSE(estimate().degraded);
  EXPECT_LT(TiltError_deg(), 1.0);
  Feed(30.0);  // and when it is plugged in, heading becomes magnetic
  EXPECT_EQ(estimate().heading, HeadingReference::kMagnetic);
  EXPECT_LT(Error_deg(), 3.0);
}

TEST_P(FilterBadInputTest, AFieldAlongTheVerticalKeepsTheTilt) {
  filter_->Reset();
  Feed(20.0, [this](MargSample& s) {
    const Vector3d almost_vertical_tesla(0.0, 1e-8, -48e-6);
    s.mag_tesla = (stream_.q_earth_sensor().conjugate() * almost_vertical_tesla).cast<float>();
  });
  EXPECT_TRUE(estimate().started);
  EXPECT_LT(TiltError_deg(), 1.0);
}

TEST_P(FilterBadInputTest, AMagnetometerThatTurnsNanIsLeftOut) {
  Feed(3.0, [](MargSample& s) { s.mag_tesla.z() = kNan; });
  EXPECT_TRUE(estimate().degraded);
  EXPECT_EQ(estimate().magnetic_state, MagneticState::kUnused);
  EXPECT_LT(Error_deg(), 1.0);
}

TEST_P(FilterBadInputTest, ASaturatedMagnetometerIsSkipped) {
  Feed(3.0, [](MargSample& s) {
    s.flags |= sensing::kMagSaturated;
    s.mag_tesla = {1e-3F, 0.0F, 0.0F};
  });
  EXPECT_EQ(estimate().magnetic_state, MagneticState::kUnused);
  EXPECT_LT(Error_deg(), 1.0);
}

// Row 6. The complementary Kalman filter takes the whole field for its innovation, as published
// (sections 2.2.1, 2.4: "the influence on the magnetic dip angle"), so it may tilt, but by no more
// than the 23 degrees that the dip has changed.
TEST_P(FilterBadInputTest, AFieldThatTurnsVerticalIsSurvived) {
  Feed(5.0, [this](MargSample& s) {
    const Vector3d vertical_tesla(0.0, 0.0, -48e-6);
    s.mag_tesla = (stream_.q_earth_sensor().conjugate() * vertical_tesla).cast<float>();
  });
  EXPECT_LT(TiltError_deg(), GetParam().starts_with("ckf") ? 23.0 : 1.5);
  Feed(30.0);
  EXPECT_LT(Error_deg(), 6.0);
}

// Row 7: (0.2 |ω|)²T on top of what the same samples do without the flag.
TEST_P(FilterBadInputTest, ASaturatedGyroWidensMoreThanTheSameReadingsDo) {
  auto twin = MakeFilter(GetParam()).value();
  std::vector<std::byte> state(filter_->state_size_bytes());
  filter_->SaveState(state);
  ASSERT_TRUE(twin->RestoreState(state).ok());
  Feed(0.3, [&](MargSample& s) {
    EXPECT_EQ(twin->Update(s), SampleVerdict::kFused);
    s.flags |= sensing::kGyroSaturated;
  });
  EXPECT_GT(estimate().cov_orientation_rad2.trace(),
            1.02 * twin->estimate().cov_orientation_rad2.trace());
}

TEST_P(FilterBadInputTest, ASaturatedGyroWidensTheCovarianceAndIsReported) {
  const double before = estimate().cov_orientation_rad2.trace();
  Feed(0.2, [](MargSample& s) {
    s.flags |= sensing::kGyroSaturated;
    s.gyro_rad_s *= 0.9F;
  });
  EXPECT_TRUE(estimate().degraded);
  EXPECT_GT(estimate().cov_orientation_rad2.trace(), before);
}

TEST_P(FilterBadInputTest, ASaturatedAccelerometerIsSkipped) {
  Feed(1.0, [](MargSample& s) {
    s.flags |= sensing::kAccelSaturated;
    s.accel_m_s2 = {156.0F, 0.0F, 0.0F};
  });
  EXPECT_TRUE(estimate().degraded);
  EXPECT_LT(Error_deg(), 1.0);
}

TEST_P(FilterBadInputTest, NothingButNanIsRefusedAndChangesNothing) {
  const auto before = estimate().q_earth_sensor.coeffs().eval();
  Feed(0.2, [](MargSample& s) {
    s.gyro_rad_s.setConstant(kNan);
    s.accel_m_s2.setConstant(std::numeric_limits<float>::infinity());
    s.mag_tesla.setConstant(kNan);
  });
  EXPECT_EQ(last_, SampleVerdict::kRejectedNotFinite);
  EXPECT_EQ(estimate().q_earth_sensor.coeffs(), before);
}

TEST_P(FilterBadInputTest, ProbesAndEmptySamplesAreNoData) {
  MargSample probe;
  probe.flags =
      sensing::kProbe | sensing::kGyroMissing | sensing::kAccelMissing | sensing::kMagMissing;
  EXPECT_EQ(filter_->Update(probe), SampleVerdict::kNoData);
  MargSample empty = stream_.Next();
  empty.flags = sensing::kGyroMissing | sensing::kAccelMissing | sensing::kMagMissing;
  EXPECT_EQ(filter_->Update(empty), SampleVerdict::kNoData);
}

TEST_P(FilterBadInputTest, AbsurdButFiniteValuesAreNotReadings) {
  Feed(0.1, [](MargSample& s) {
    s.gyro_rad_s.setConstant(3e38F);
    s.accel_m_s2.setConstant(-3e38F);
  });
  Feed(30.0);
  EXPECT_LT(Error_deg(), 6.0);
}

// Row 8 for the complementary Kalman filter; bounded_motion_corrections_test has it for the other.
// The covariance is found in the saved bytes by its values right after the start.
class KalmanCovarianceTest : public ::testing::TestWithParam<double> {};

TEST_P(KalmanCovarianceTest, ThatLostItsMeaningIsSetBackAndTheStatesStay) {
  const ComplementaryKalmanConfig config;
  ComplementaryKalman filter(config);
  MargStream stream({.rate_rms_rad_s = 0.0});
  while (!filter.estimate().started) {
    ASSERT_TRUE(IsUsed(filter.Update(stream.Next())));
  }
  std::vector<std::byte> saved(filter.state_size_bytes());
  filter.SaveState(saved);
  const double theta = config.sigma_orientation_start_rad;
  const double bias = config.sigma_gyro_bias_start_rad_s;
  Matrix9 P = Matrix9::Zero();
  P.diagonal().head<6>() << Vector3d::Constant(theta * theta), Vector3d::Constant(bias * bias);
  const auto wanted = std::as_bytes(std::span(P.data(), 81));
  const auto found = std::search(saved.begin(), saved.end(), wanted.begin(), wanted.end());
  ASSERT_NE(found, saved.end());
  P(1, 1) = GetParam();
  std::memcpy(&*found, P.data(), sizeof P);
  SavedStateHeader header;
  std::memcpy(&header, saved.data(), sizeof header);
  header = MakeStateHeader("ckf", header.version, std::span(saved).subspan(sizeof header));
  std::memcpy(saved.data(), &header, sizeof header);
  ASSERT_TRUE(filter.RestoreState(saved).ok());

  EXPECT_EQ(filter.Update(stream.Next()), SampleVerdict::kFused);
  EXPECT_EQ(filter.covariance_resets(), 1U);
  EXPECT_LT(math::AngleBetween_rad(filter.estimate().q_earth_sensor, stream.q_earth_sensor()),
            0.5 * kDeg);
  EXPECT_TRUE(filter.estimate().cov_orientation_rad2.allFinite());
  EXPECT_EQ(filter.Update(stream.Next()), SampleVerdict::kFused);
  EXPECT_EQ(filter.covariance_resets(), 1U);
}

INSTANTIATE_TEST_SUITE_P(Damage, KalmanCovarianceTest, ::testing::Values(-1.0, double{kNan}));

INSTANTIATE_TEST_SUITE_P(Filters, FilterBadInputTest,
                         ::testing::ValuesIn(FilterNames().begin(), FilterNames().end()),
                         [](const auto& test) {
                           std::string name(test.param);
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace limbcast::filters
