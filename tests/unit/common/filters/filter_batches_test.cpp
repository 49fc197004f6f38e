#include "common/filters/filter_batches.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "common/filters/filter_factory.hpp"
#include "common/math/rotation.hpp"
#include "tests/support/allocation_counter.hpp"
#include "tests/unit/common/filters/marg_stream.hpp"

namespace limbcast::filters {
namespace {

using sensing::MargFlag;
using sensing::MargSample;

constexpr std::size_t kSensors = 11;  // a full batch and a part of one
constexpr double kDegrees = 180.0 / std::numbers::pi;

/// One sensor's minutes on a limb, with all that goes wrong: each sensor at other moments.
class HardStream {
 public:
  explicit HardStream(unsigned seed) : seed_(seed), stream_(Config(seed)) {}

  MargSample Next() {
    ++count_;
    const unsigned phase = count_ + 37 * seed_;
    if (phase % 1'500 == 0) {
      stream_.Skip(0.2);  // a gap to bridge
    } else if (phase % 3'700 == 0) {
      stream_.Skip(0.9);  // one that starts again
    }
    MargSample sample = stream_.Next();
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    if (seed_ % 3 == 1 && phase % 2 == 0) {
      sample.flags |= MargFlag::kMagMissing;  // a slower magnetometer
      sample.mag_tesla.setConstant(kNan);
    }
    if (seed_ == 5 && count_ < 800) {
      sample.flags |= MargFlag::kMagMissing;  // north comes late
    }
    if (phase % 211 == 0) {
      sample.gyro_rad_s.y() = kNan;
    }
    if (phase % 2'300 < 12) {
      sample.flags |= MargFlag::kGyroMissing;  // too long to hold
    }
    if (phase % 317 == 0) {
      sample.accel_m_s2.x() = std::numeric_limits<float>::infinity();
    }
    if (phase % 401 == 0) {
      sample.mag_tesla.z() = kNan;
    }
    if (phase % 523 == 0) {
      sample.flags |= MargFlag::kGyroSaturated;
    }
    if (phase % 601 < 3) {
      sample.flags |= MargFlag::kAccelSaturated | MargFlag::kMagSaturated;
    }
    if (phase % 997 == 0) {
      sample.accel_m_s2.setZero();
      sample.gyro_rad_s.setConstant(kNan);
      sample.mag_tesla.setZero();
    }
    if (phase % 701 == 0) {
      sample.measured_at = last_.measured_at;
    }
    last_ = sample;
    return sample;
  }

 private:
  static test_support::MargStreamConfig Config(unsigned seed) {
    test_support::MargStreamConfig config;
    config.seed = seed + 1;
    config.rest_s = 2.0 + 0.5 * seed;
    config.rate_rms_rad_s = seed % 4 == 3 ? 8.0 : 1.5;
    config.accel_rms_m_s2 = 2.0;
    config.gyro_bias_rad_s = {0.01, -0.005, 0.002 * seed};
    config.gyro_noise_rad_s = 0.002;
    config.accel_noise_m_s2 = 0.05;
    config.mag_noise_tesla = 5e-7;
    config.nearby_tesla = [seed](double t) -> Eigen::Vector3d {
      return std::fmod(t + seed, 15.0) > 11.0 ? Eigen::Vector3d(20e-6, 0.0, 5e-6)
                                              : Eigen::Vector3d::Zero();
    };
    config.carried_tesla = [seed](double t) -> Eigen::Vector3d {
      return seed == 2 && t > 20.0 ? Eigen::Vector3d(15e-6, 10e-6, 0.0) : Eigen::Vector3d::Zero();
    };
    return config;
  }

  unsigned seed_;
  unsigned count_ = 0;
  test_support::MargStream stream_;
  MargSample last_;
};

struct Case {
  std::string name;
  std::vector<Setting> settings;
  double most_deg;  // from the single form; 0 = the same bits
};

std::unique_ptr<OrientationFilter> Make(const Case& c) {
  return std::move(*MakeFilter(c.name, c.settings));
}

void ExpectSame(const FilterEstimate& batched, const FilterEstimate& single, double most_deg) {
  ASSERT_EQ(batched.started, single.started);
  ASSERT_EQ(batched.degraded, single.degraded);
  ASSERT_EQ(batched.heading, single.heading);
  if (most_deg == 0.0) {
    ASSERT_EQ(batched.q_earth_sensor.coeffs(), single.q_earth_sensor.coeffs());
    ASSERT_EQ(batched.gyro_bias_rad_s, single.gyro_bias_rad_s);
    ASSERT_EQ(batched.w_earth_sensor_in_sensor_rad_s, single.w_earth_sensor_in_sensor_rad_s);
    ASSERT_EQ(batched.free_accel_in_earth_m_s2, single.free_accel_in_earth_m_s2);
    ASSERT_EQ(batched.cov_orientation_rad2, single.cov_orientation_rad2);
    ASSERT_EQ(batched.at_rest, single.at_rest);
    ASSERT_EQ(batched.magnetic_state, single.magnetic_state);
  } else {
    const double angle_deg =
        kDegrees * math::AngleBetween_rad(batched.q_earth_sensor, single.q_earth_sensor);
    ASSERT_LT(angle_deg, most_deg);
  }
}

class FilterBatchesTest : public ::testing::TestWithParam<Case> {
 protected:
  // Two minutes of all sensors through batches and one by one.
  static void Compare(const BatchKernels& kernels) {
    FilterBatches batches(kernels);
    std::vector<HardStream> streams;
    std::vector<std::unique_ptr<OrientationFilter>> seated;
    std::vector<std::unique_ptr<OrientationFilter>> single;
    for (std::size_t i = 0; i < kSensors; ++i) {
      streams.emplace_back(static_cast<unsigned>(i));
      seated.push_back(batches.Seat(Make(GetParam())));
      single.push_back(Make(GetParam()));
      ASSERT_NE(seated.back()->batched(), nullptr);
    }
    ASSERT_EQ(batches.batch_count(), 2U);
    for (int step = 0; step < 12'000; ++step) {
      std::vector<std::size_t> those;
      for (std::size_t i = 0; i < kSensors; ++i) {
        if ((static_cast<std::size_t>(step) + i) % 5 != 0) {  // somebody is always late
          those.push_back(i);
        }
      }
      std::vector<MargSample> samples;
      for (const std::size_t i : those) {
        samples.push_back(streams[i].Next());
        seated[i]->batched()->Submit(samples.back());
      }
      batches.Run();
      for (std::size_t k = 0; k < those.size(); ++k) {
        const std::size_t i = those[k];
        SCOPED_TRACE("sensor " + std::to_string(i) + " step " + std::to_string(step));
        ASSERT_EQ(seated[i]->batched()->Take(), single[i]->Update(samples[k]));
        ASSERT_NO_FATAL_FAILURE(
            ExpectSame(seated[i]->estimate(), single[i]->estimate(), GetParam().most_deg));
      }
    }
  }
};

TEST_P(FilterBatchesTest, BatchedIsLikeSingleOnThisMachine) { Compare(BestKernels()); }

TEST_P(FilterBatchesTest, BatchedIsLikeSingleOnAnyMachine) { Compare(BaselineKernels()); }

TEST_P(FilterBatchesTest, WhoElseSitsThereChangesNoBit) {
  FilterBatches company;
  FilterBatches alone;
  std::vector<std::unique_ptr<OrientationFilter>> others;
  std::vector<HardStream> streams;
  for (unsigned i = 0; i < 5; ++i) {
    others.push_back(company.Seat(Make(GetParam())));
    streams.emplace_back(i + 1);
  }
  const auto in_company = company.Seat(Make(GetParam()));
  const auto by_itself = alone.Seat(Make(GetParam()));
  HardStream stream(0);
  for (int step = 0; step < 6'000; ++step) {
    std::vector<std::size_t> those;
    for (std::size_t i = 0; i < others.size(); ++i) {
      if (static_cast<std::size_t>(step) % (i + 1) == 0) {
        others[i]->batched()->Submit(streams[i].Next());
        those.push_back(i);
      }
    }
    const MargSample sample = stream.Next();
    in_company->batched()->Submit(sample);
    company.Run();
    for (const std::size_t i : those) {
      static_cast<void>(others[i]->batched()->Take());
    }
    ASSERT_EQ(in_company->batched()->Take(), by_itself->Update(sample));
    ASSERT_NO_FATAL_FAILURE(ExpectSame(in_company->estimate(), by_itself->estimate(), 0.0));
  }
}

TEST_P(FilterBatchesTest, ASavedStateRestoresBitForBitIntoAnotherSeat) {
  FilterBatches batches;
  const auto first = batches.Seat(Make(GetParam()));
  const auto second = batches.Seat(Make(GetParam()));
  HardStream stream(4);
  for (int i = 0; i < 1'000; ++i) {
    static_cast<void>(first->Update(stream.Next()));
  }
  std::vector<std::byte> saved(first->state_size_bytes());
  first->SaveState(saved);
  ASSERT_TRUE(second->RestoreState(saved).ok());
  for (int i = 0; i < 1'000; ++i) {
    const MargSample sample = stream.Next();
    ASSERT_EQ(first->Update(sample), second->Update(sample));
    ASSERT_NO_FATAL_FAILURE(ExpectSame(first->estimate(), second->estimate(), 0.0));
  }
}

TEST_P(FilterBatchesTest, NoStepAllocates) {
  FilterBatches batches;
  const auto filter = batches.Seat(Make(GetParam()));
  HardStream stream(3);
  std::vector<MargSample> samples;
  for (int i = 0; i < 5'000; ++i) {
    samples.push_back(stream.Next());
  }
  const std::size_t before = test_support::AllocationCount();
  for (const MargSample& sample : samples) {
    filter->batched()->Submit(sample);
    batches.Run();
    static_cast<void>(filter->batched()->Take());
  }
  EXPECT_EQ(test_support::AllocationCount(), before);
}

INSTANTIATE_TEST_SUITE_P(
    Filters, FilterBatchesTest,
    ::testing::Values(Case{"tqt", {}, 0.0}, Case{"tqt", {{"precision", "float"}}, 0.0},
                      Case{"tqt", {{"iterations", "3"}, {"k_per_s", "1"}}, 0.0},
                      Case{"bmf", {{"precision", "double"}}, 1e-5},
                      Case{"bmf-plain", {{"precision", "double"}}, 1e-5},
                      // Half a bit in single precision is 3.4e-6 degrees; 12 000 steps of such
                      // roundings, each its own way, add up to 4e-4.
                      Case{"bmf", {}, 1e-3}, Case{"bmf-plain", {}, 1e-3}),
    [](const auto& tested) {
      std::string name = tested.param.name == "bmf-plain" ? "bmf_plain" : tested.param.name;
      return name + std::to_string(tested.param.settings.size());
    });

TEST(FilterBatchesSeatTest, FiltersWithoutABatchAreGivenBack) {
  FilterBatches batches;
  EXPECT_EQ(batches.Seat(std::move(*MakeFilter("ckf")))->batched(), nullptr);
  const std::vector<Setting> full = {{"form", "full"}};
  EXPECT_EQ(batches.Seat(std::move(*MakeFilter("tqt", full)))->batched(), nullptr);
  const std::vector<Setting> full_float = {{"form", "full"}, {"precision", "float"}};
  EXPECT_EQ(batches.Seat(std::move(*MakeFilter("tqt", full_float)))->batched(), nullptr);
  EXPECT_EQ(batches.batch_count(), 0U);
}

TEST(FilterBatchesSeatTest, OnlyEqualConfigurationsSitTogetherAndFreedSeatsAreUsedAgain) {
  FilterBatches batches;
  const std::vector<Setting> quick = {{"k_per_s", "1"}};
  auto a = batches.Seat(std::move(*MakeFilter("tqt")));
  auto b = batches.Seat(std::move(*MakeFilter("tqt", quick)));
  EXPECT_EQ(batches.batch_count(), 2U);
  auto c = batches.Seat(std::move(*MakeFilter("tqt")));
  EXPECT_EQ(batches.batch_count(), 2U);
  a.reset();
  c.reset();
  a = batches.Seat(std::move(*MakeFilter("tqt", quick)));
  EXPECT_EQ(batches.batch_count(), 1U);
}

}  // namespace
}  // namespace limbcast::filters
