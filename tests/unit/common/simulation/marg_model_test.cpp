#include "common/simulation/marg_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "common/math/rotation.hpp"
#include "common/simulation/sensor_set.hpp"

namespace limbcast::simulation {
namespace {

constexpr double kDeg = std::numbers::pi / 180.0;

struct Walker {
  PersonMotion person = *PersonMotion::Make(*MakePersonShape(1.75), {.start = {0.0, 0.0, 0.9}});
  MagneticWorld world;

  [[nodiscard]] IdealMarg Read(body::Segment segment, double t_s) const {
    const SensorMounting mounting =
        MakeMounting(segment, person.shape(), MountingStyle::kArbitrary, 5);
    return MakeIdealMarg(person.At(t_s).segments[body::Index(segment)], mounting, world);
  }
};

TEST(IdealMargTest, AtRestTheUpwardAxisReadsPlusG) {
  const Walker walker;
  const IdealMarg ideal = walker.Read(body::Segment::kLeftForeArm, 2.0);
  const Eigen::Vector3d force_earth_m_s2 = ideal.q_earth_sensor * ideal.accel_m_s2;
  EXPECT_LT((force_earth_m_s2 - Eigen::Vector3d(0.0, 0.0, 9.80665)).norm(), 1e-12);
  EXPECT_LT(ideal.gyro_rad_s.norm(), 1e-15);
  EXPECT_LT((ideal.q_earth_sensor * ideal.mag_tesla - EarthField_tesla({})).norm(), 1e-18);
}

// Rotation over one step from three rates, by the fourth-order Magnus expansion (Iserles et al.,
// "Lie-group methods", Acta Numerica 2000, Eq. (5.9) with Simpson's rule).
Eigen::Quaterniond Step(const Eigen::Vector3d& begin, const Eigen::Vector3d& middle,
                        const Eigen::Vector3d& end, double step_s) {
  const Eigen::Vector3d mean = (begin + 4.0 * middle + end) / 6.0;
  const Eigen::Vector3d commutator = begin.cross(end) * (step_s * step_s / 12.0);
  return math::ExpSO3(mean * step_s + commutator);
}

TEST(IdealMargTest, IntegratingTheGyroForAMinuteGivesTheOrientation) {
  const Walker walker;
  constexpr double kStep_s = 0.005;
  for (const auto segment : {body::Segment::kLeftHand, body::Segment::kRightFoot,
                             body::Segment::kHead, body::Segment::kRightLowerLeg}) {
    IdealMarg at = walker.Read(segment, 0.0);
    Eigen::Quaterniond q_earth_sensor = at.q_earth_sensor;
    for (int i = 0; i < 12'000; ++i) {
      const double t_s = kStep_s * i;
      const IdealMarg middle = walker.Read(segment, t_s + 0.5 * kStep_s);
      const IdealMarg end = walker.Read(segment, t_s + kStep_s);
      q_earth_sensor =
          q_earth_sensor * Step(at.gyro_rad_s, middle.gyro_rad_s, end.gyro_rad_s, kStep_s);
      at = end;
    }
    EXPECT_LT(math::AngleBetween_rad(q_earth_sensor, at.q_earth_sensor), 0.01 * kDeg)
        << body::ToString(segment);
  }
}

TEST(IdealMargTest, IntegratingTheAccelerometerTwiceGivesThePosition) {
  const Walker walker;
  constexpr double kStep_s = 0.0005;
  for (const auto segment : {body::Segment::kLeftHand, body::Segment::kRightFoot}) {
    const auto accel = [&](const IdealMarg& at) {
      return Eigen::Vector3d(at.q_earth_sensor * at.accel_m_s2 -
                             kGravity_m_s2 * Eigen::Vector3d::UnitZ());
    };
    IdealMarg at = walker.Read(segment, 0.0);
    Eigen::Vector3d p_m = at.p_earth_sensor_m;
    Eigen::Vector3d v_m_s = Eigen::Vector3d::Zero();
    for (int i = 0; i < 24'000; ++i) {  // to 12 s: well into the walk
      const IdealMarg middle = walker.Read(segment, kStep_s * (i + 0.5));
      const IdealMarg end = walker.Read(segment, kStep_s * (i + 1.0));
      // Simpson's rule for speed and place.
      p_m += v_m_s * kStep_s + kStep_s * kStep_s / 6.0 * (accel(at) + 2.0 * accel(middle));
      v_m_s += kStep_s / 6.0 * (accel(at) + 4.0 * accel(middle) + accel(end));
      at = end;
    }
    EXPECT_GT(p_m.head<2>().norm(), 0.5);  // it did go somewhere
    EXPECT_LT((p_m - at.p_earth_sensor_m).norm(), 1e-3) << body::ToString(segment);
  }
}

sensing::MargSample ReadOnce(MargModel& model, const IdealMarg& ideal) {
  sensing::MargSample sample;
  model.Read(ideal, sample);
  return sample;
}

TEST(MargModelTest, IdealPresetChangesNothing) {
  MargModel model(MakeMargErrors(NoisePreset::kIdeal), 100.0, Random(1));
  IdealMarg ideal;
  ideal.gyro_rad_s = {0.1, -0.2, 0.3};
  ideal.mag_tesla = {1e-5, 2e-5, -3e-5};
  const auto sample = ReadOnce(model, ideal);
  EXPECT_EQ(sample.gyro_rad_s, ideal.gyro_rad_s.cast<float>());
  EXPECT_EQ(sample.mag_tesla, ideal.mag_tesla.cast<float>());
  EXPECT_EQ(sample.flags, 0U);
}

TEST(MargModelTest, NoiseDensityAndBiasAreAsConfigured) {
  MargErrors errors;
  errors.gyro.noise_rthz = 0.01 * kDeg;
  errors.accel.noise_rthz = 1.5e-3;
  errors.mag.noise = 3e-7;
  errors.gyro.bias = 0.3 * kDeg;
  constexpr double kRate_hz = 200.0;
  MargModel model(errors, kRate_hz, Random(2));
  constexpr int kCount = 20'000;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d square = Eigen::Vector3d::Zero();
  double accel_square = 0.0;
  double mag_square = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const auto sample = ReadOnce(model, {});
    const Eigen::Vector3d gyro = sample.gyro_rad_s.cast<double>();
    sum += gyro / kCount;
    square += (gyro - model.gyro_bias_rad_s()).cwiseAbs2() / kCount;
    accel_square += sample.accel_m_s2.cast<double>().squaredNorm() / (3 * kCount);
    mag_square += sample.mag_tesla.cast<double>().squaredNorm() / (3 * kCount);
  }
  const double sigma_rad_s = 0.01 * kDeg * std::sqrt(kRate_hz / 2.0);
  EXPECT_LT((sum - model.gyro_bias_rad_s()).norm(), 5.0 * sigma_rad_s / std::sqrt(kCount));
  EXPECT_LE(model.gyro_bias_rad_s().cwiseAbs().maxCoeff(), 0.3 * kDeg);
  EXPECT_NEAR(std::sqrt(square.mean()), sigma_rad_s, 0.02 * sigma_rad_s);
  EXPECT_NEAR(std::sqrt(accel_square), 1.5e-3 * 10.0, 0.02 * 1.5e-3 * 10.0);
  EXPECT_NEAR(std::sqrt(mag_square), 3e-7, 0.02 * 3e-7);
}

TEST(MargModelTest, BiasWalksAndFollowsTheTemperature) {
  MargErrors errors;
  errors.gyro.bias_walk_rts = 0.01;
  double square = 0.0;
  constexpr int kSensors = 400;
  for (int i = 0; i < kSensors; ++i) {
    MargModel model(errors, 10.0, Random(static_cast<std::uint64_t>(i)));
    for (int tick = 0; tick < 250; ++tick) {
      ReadOnce(model, {});
    }
    square += model.gyro_bias_rad_s().squaredNorm() / (3.0 * kSensors);
  }
  EXPECT_NEAR(std::sqrt(square), 0.01 * std::sqrt(25.0), 0.005);  // σ·√t after 25 s

  MargErrors warming;
  warming.gyro.bias_per_celsius = 0.01;
  warming.warm_up_celsius = 10.0;
  warming.warm_up_time_s = 1.0;
  MargModel model(warming, 10.0, Random(3));
  EXPECT_EQ(ReadOnce(model, {}).temperature_celsius, 25.0F);
  EXPECT_EQ(model.gyro_bias_rad_s().norm(), 0.0);
  sensing::MargSample warm;
  for (int tick = 0; tick < 200; ++tick) {
    warm = ReadOnce(model, {});
  }
  EXPECT_NEAR(warm.temperature_celsius, 35.0F, 1e-3);
  EXPECT_GT(model.gyro_bias_rad_s().norm(), 0.005);
}

TEST(MargModelTest, ScaleAndMisalignmentStayWithinTheirLimits) {
  MargErrors errors;
  errors.accel.scale = 0.01;
  errors.accel.misalignment = 0.002;
  MargModel model(errors, 100.0, Random(8));
  for (int axis = 0; axis < 3; ++axis) {
    IdealMarg ideal;
    ideal.accel_m_s2[axis] = 10.0;
    const auto reading = ReadOnce(model, ideal).accel_m_s2.cast<double>().eval();
    for (int other = 0; other < 3; ++other) {
      const double error = reading[other] - ideal.accel_m_s2[other];
      EXPECT_LE(std::abs(error), (other == axis ? 0.1 : 0.02) + 1e-6);
      EXPECT_GT(std::abs(error), 0.0);
    }
  }
}

TEST(MargModelTest, ClipsFlagsAndRounds) {
  MargErrors errors;
  errors.gyro.range = 2.0;
  errors.gyro.resolution = 0.25;
  MargModel model(errors, 100.0, Random(1));
  IdealMarg ideal;
  ideal.gyro_rad_s = {0.3, -5.0, 1.1};
  const auto sample = ReadOnce(model, ideal);
  EXPECT_EQ(sample.gyro_rad_s, Eigen::Vector3f(0.25F, -2.0F, 1.0F));
  EXPECT_TRUE(sample.Has(sensing::kGyroSaturated));
  EXPECT_FALSE(sample.Has(sensing::kAccelSaturated));
}

TEST(MargModelTest, PresetsGetWorseAndValidateNamesTheKey) {
  const auto good = MakeMargErrors(NoisePreset::kDefault);
  const auto poor = MakeMargErrors(NoisePreset::kPoor);
  EXPECT_GT(poor.gyro.bias, good.gyro.bias);
  EXPECT_GT(poor.mag.noise, good.mag.noise);
  EXPECT_TRUE(Validate(good).ok());
  MargErrors wrong = good;
  wrong.accel.noise_rthz = -1.0;
  EXPECT_NE(Validate(wrong).error().message.find("accel.noise_rthz"), std::string::npos);
}

}  // namespace
}  // namespace limbcast::simulation
