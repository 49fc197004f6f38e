// Does the covariance that a filter reports mean what it says? Normalised estimation error squared,
// eᵀP⁻¹e with the earth-frame rotation error e: its mean is 3, the dimension, when noise and motion
// are what the filter models, and P is right (Bar-Shalom, Li, Kirubarajan, "Estimation with
// Applications to Tracking and Navigation", 2001, section 5.4.2).
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <iostream>
#include <memory>
#include <string>

#include "common/filters/filter_factory.hpp"
#include "common/math/rotation.hpp"
#include "common/simulation/random.hpp"
#include "tests/unit/common/filters/marg_stream.hpp"

namespace limbcast {
namespace {

using Eigen::Vector3d;
using test_support::MargStream;
using test_support::MargStreamConfig;

constexpr double kRate_hz = 100.0;
constexpr double kField_tesla = 48e-6;
constexpr int kRuns = 20;
constexpr double kRun_s = 40.0;
// No noise while filters take their reference from the field: an error in it is none of what they
// model, and stays.
constexpr int kQuietRows = 100;

// The acceleration model of the complementary Kalman filter [R·2.5]: a first-order process in the
// earth frame, c_a = 0.3 and a drive of 5 m/s² every 10 ms.
class DrivenAcceleration {
 public:
  explicit DrivenAcceleration(simulation::Random random) : random_(random) {}
  [[nodiscard]] Vector3d Next() {
    a_m_s2_ = 0.3 * a_m_s2_ + 5.0 * random_.Gaussian3();
    return a_m_s2_;
  }

 private:
  simulation::Random random_;
  Vector3d a_m_s2_ = Vector3d::Zero();
};

struct Noise {
  double gyro_rad_s = 0.0;
  double accel_m_s2 = 0.0;
  double mag_tesla = 0.0;
  bool driven_acceleration = false;
  double bounded_acceleration_m_s2 = 0.0;
  double gyro_bias_rad_s = 0.0;  ///< standard deviation
};

// Mean over the runs, once a second after the first five.
double MeanNees(const std::string& filter_name, const Noise& noise) {
  double sum = 0.0;
  int count = 0;
  for (unsigned run = 1; run <= kRuns; ++run) {
    simulation::Random random(run, "consistency");
    MargStreamConfig config;
    config.rate_hz = kRate_hz;
    config.seed = run;
    config.accel_rms_m_s2 = noise.bounded_acceleration_m_s2;
    config.gyro_bias_rad_s = noise.gyro_bias_rad_s * random.Gaussian3();
    MargStream stream(config);
    DrivenAcceleration driven{simulation::Random(run, "acceleration")};
    const auto filter = filters::MakeFilter(filter_name).value();
    for (int row = 1; row <= kRun_s * kRate_hz; ++row) {
      sensing::MargSample sample = stream.Next();
      if (row > kQuietRows) {
        const auto add = [&random](double sigma) -> Eigen::Vector3f {
          return (sigma * random.Gaussian3()).cast<float>();
        };
        sample.gyro_rad_s += add(noise.gyro_rad_s);
        sample.accel_m_s2 += add(noise.accel_m_s2);
        sample.mag_tesla += add(noise.mag_tesla);
      }
      if (row > kQuietRows && noise.driven_acceleration) {
        sample.accel_m_s2 += (stream.q_earth_sensor().conjugate() * driven.Next()).cast<float>();
      }
      static_cast<void>(filter->Update(sample));
      if (row < 500 || row % 100 != 0) {
        continue;
      }
      const Vector3d error_rad =
          math::LogSO3(stream.q_earth_sensor() * filter->estimate().q_earth_sensor.conjugate());
      sum += error_rad.dot(filter->estimate().cov_orientation_rad2.ldlt().solve(error_rad));
      ++count;
    }
  }
  const double mean = sum / count;
  std::cout << filter_name << ": NEES " << mean << " of 3\n";
  ::testing::Test::RecordProperty("nees", std::to_string(mean));
  return mean;
}

// 720 values, of which those of one run hang together: with an independent one every few seconds
// (some 150 in all) the mean of a right filter scatters by √(2·3/150) = 0.2, so 2 to 4.5 is a
// filter whose σ is right within a fifth, with the rest for what linearisation does at these
// noises (an acceleration of half a g in every sample).
TEST(ConsistencyTest, TheComplementaryKalmanFilterIsRightAboutWhatItModels) {
  const Noise modelled{.gyro_rad_s = 0.037,
                       .accel_m_s2 = 0.05,
                       .mag_tesla = 0.27 * kField_tesla,
                       .driven_acceleration = true,
                       .gyro_bias_rad_s = 0.005};
  for (const char* name : {"ckf", "ckf-plain"}) {
    const double nees = MeanNees(name, modelled);
    EXPECT_GT(nees, 2.0) << name;
    EXPECT_LT(nees, 4.5) << name;
  }
}

// The bounded-motion filter allows for more than its white noises (motion bounds, field deviations,
// nine gyro errors), so it is careful on them: below 3, never above 6 (σ at most √2 too small).
TEST(ConsistencyTest, TheBoundedMotionFilterIsNotSureOfWhatIsWrong) {
  const Noise modelled{.gyro_rad_s = 2e-4 * std::sqrt(kRate_hz),
                       .accel_m_s2 = 0.01 * std::sqrt(kRate_hz),
                       .mag_tesla = 0.05 * kField_tesla,
                       .bounded_acceleration_m_s2 = 0.5,
                       .gyro_bias_rad_s = 0.003};
  for (const char* name : {"bmf", "bmf-plain"}) {
    const double nees = MeanNees(name, modelled);
    EXPECT_GT(nees, 0.05) << name;
    EXPECT_LT(nees, 6.0) << name;
  }
}

// tqt has no covariance; what it reports instead is meant for limbs that move beside iron. On a
// sensor that is better off it must be on the careful side.
TEST(ConsistencyTest, TheGaussNewtonFilterReportsNoLessThanItErrs) {
  const double nees = MeanNees("tqt", {.gyro_rad_s = 2e-3,
                                       .accel_m_s2 = 0.1,
                                       .mag_tesla = 0.02 * kField_tesla,
                                       .bounded_acceleration_m_s2 = 2.0,
                                       .gyro_bias_rad_s = 0.002});
  EXPECT_GT(nees, 0.005);
  EXPECT_LT(nees, 6.0);
}

}  // namespace
}  // namespace limbcast
