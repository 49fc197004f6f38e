#include "common/simulation/coil_stream.hpp"

#include <gtest/gtest.h>

#include "common/math/rotation.hpp"

namespace limbcast::simulation {
namespace {

CoilStreamConfig StillScene() {
  CoilStreamConfig config;
  config.pulses = ThesisPulses();
  config.sensor = [](double) {
    RigidMotion motion;
    motion.R_earth_local = math::ExpSO3({0.3, -0.4, 1.0}).toRotationMatrix();
    motion.p_earth_local_m = {0.1, 0.2, 1.3};
    return motion;
  };
  config.emitter = [](double) {
    RigidMotion motion;
    motion.R_earth_local = math::ExpSO3({0.0, 0.2, 0.5}).toRotationMatrix();
    motion.p_earth_local_m = {0.0, 0.0, 1.0};
    return motion;
  };
  config.errors = MakeMargErrors(NoisePreset::kIdeal);
  return config;
}

TEST(CoilStreamTest, ThePulseIsTheFieldOfTheCoilAboveTheBackground) {
  const CoilStreamConfig config = StillScene();
  const auto ticks = SimulateCoil(config, 2.0, 1);
  ASSERT_EQ(ticks.size(), 240U);
  const Eigen::Vector3d background = ticks.front().frame.mag_tesla;
  int on = 0;
  for (const CoilTick& tick : ticks) {
    if (!tick.frame.drive.settled) {
      continue;
    }
    Eigen::Vector3d expected = background;
    if (tick.frame.drive.coil >= 0) {
      ++on;
      expected += tick.q_sensor_emitter * sensing::CoilField(config.source, tick.frame.drive.coil,
                                                             tick.frame.drive.current_a,
                                                             tick.p_emitter_sensor_m)
                                              .field_tesla;
    }
    EXPECT_LT((tick.frame.mag_tesla - expected).norm(), 5e-9);
  }
  EXPECT_GT(on, 20);
}

TEST(CoilStreamTest, TheSourcesOwnMagnetometerFeelsTheRoomBetweenPulsesAndItsCoilsInThem) {
  CoilStreamConfig config = StillScene();
  config.gradient_tesla_m.diagonal() = Eigen::Vector3d(1e-6, 2e-6, -3e-6);
  config.errors.mag.range = 150e-6;
  const auto ticks = SimulateCoil(config, 2.0, 1);
  const RigidMotion emitter = config.emitter(0.0);
  // The gradient counts from where the sensor began: 0.1, 0.2 and 0.3 m away.
  const Eigen::Vector3d here_E =
      config.world.At(emitter.p_earth_local_m) +
      config.gradient_tesla_m * Eigen::Vector3d(-0.1, -0.2, -0.3).array().sin().matrix();
  const Eigen::Vector3d expected = emitter.R_earth_local.transpose() * here_E;
  int quiet = 0;
  int clipped = 0;
  Time on_at = ticks.front().frame.measured_at;
  for (const CoilTick& tick : ticks) {
    EXPECT_TRUE(tick.frame.emitter_mag_valid || tick.frame.drive.coil >= 0 ||
                !tick.frame.drive.settled);
    if (tick.frame.drive.coil >= 0 || !tick.frame.drive.settled) {
      on_at = tick.frame.measured_at;
      clipped += tick.frame.emitter_mag_valid ? 0 : 1;
    } else if (ToSeconds(tick.frame.measured_at - on_at) > 0.015) {
      ++quiet;
      EXPECT_LT((tick.frame.emitter_mag_tesla - expected).norm(), 5e-9);
    }
  }
  EXPECT_GT(quiet, 50);
  EXPECT_GT(clipped, 20) << "a coil of 75 ampere turns around it is 0.9 mT";
  config.emitter_magnetometer = false;
  EXPECT_FALSE(SimulateCoil(config, 0.1, 1).front().frame.emitter_mag_valid);
}

TEST(CoilStreamTest, TonesAreTheFieldOfAllCoilsAboveTheBackground) {
  CoilStreamConfig config = StillScene();
  config.tones = sensing::CoilTones{};
  const auto ticks = SimulateCoil(config, 2.0, 1);
  const Eigen::Vector3d background = ticks.front().frame.mag_tesla;
  int on = 0;
  for (const CoilTick& tick : ticks) {
    if (tick.frame.drive.coil != sensing::kAllCoils) {
      EXPECT_LT(tick.frame.drive.coil, 0);
      continue;
    }
    ++on;
    EXPECT_TRUE(tick.frame.drive.settled);
    const Eigen::Vector3d expected =
        background + tick.q_sensor_emitter * sensing::CoilsField(config.source,
                                                                 tick.frame.drive.tones_a,
                                                                 tick.p_emitter_sensor_m)
                                                 .field_tesla;
    EXPECT_LT((tick.frame.mag_tesla - expected).norm(), 5e-9);
  }
  EXPECT_EQ(on, 120) << "from begin_s = 1 s on";
}

TEST(CoilStreamTest, IsTheSameForTheSameSeed) {
  CoilStreamConfig config = StillScene();
  config.errors = CoilSensorErrors(50e-9);
  const auto a = SimulateCoil(config, 1.0, 7);
  const auto b = SimulateCoil(config, 1.0, 7);
  const auto c = SimulateCoil(config, 1.0, 8);
  EXPECT_EQ(a.back().frame.mag_tesla, b.back().frame.mag_tesla);
  EXPECT_NE(a.back().frame.mag_tesla, c.back().frame.mag_tesla);
}

TEST(CoilStreamTest, CloseToTheCoilsTheMagnetometerClips) {
  CoilStreamConfig config = StillScene();
  config.errors = CoilSensorErrors(50e-9);
  config.sensor = [](double) {
    RigidMotion motion;
    motion.p_earth_local_m = {0.0, 0.0, 1.07};
    return motion;
  };
  int clipped = 0;
  for (const CoilTick& tick : SimulateCoil(config, 2.0, 1)) {
    clipped += tick.frame.mag_valid ? 0 : 1;
  }
  EXPECT_GT(clipped, 5);
}

TEST(CoilStreamTest, SlotsOfAnotherSourceAreMasked) {
  CoilStreamConfig config = StillScene();
  ForeignSource other;
  other.motion = [](double) {
    RigidMotion motion;
    motion.p_earth_local_m = {1.5, 0.0, 1.0};
    return motion;
  };
  other.pulses = ThesisPulses();
  other.pulses.begin_s += 0.1;
  config.foreign.push_back(other);
  const auto masked = SimulateCoil(config, 2.0, 1);
  const Eigen::Vector3d background = masked.front().frame.mag_tesla;
  for (const CoilTick& tick : masked) {
    if (tick.frame.drive.settled && tick.frame.drive.coil < 0) {
      EXPECT_LT((tick.frame.mag_tesla - background).norm(), 3e-9);
    }
  }
}

TEST(CoilStreamTest, OnDemandAPulseBeginsWithTheNextTickAndIsThatOfTheTrain) {
  CoilStreamConfig config = StillScene();
  config.pulses.begin_s = 0.5;
  config.pulses.cycle_s = 60.0;  // the first pulse of the train alone
  const auto train = SimulateCoil(config, 1.0, 1);
  config.on_demand = true;
  CoilStream stream(config, 1);
  int on = 0;
  for (std::size_t k = 0; k < train.size(); ++k) {
    if (k == 60) {
      stream.Pulse(0, config.pulses.current_a);
    }
    const CoilTick tick = stream.Next();
    EXPECT_EQ(tick.frame.drive.coil, train[k].frame.drive.coil) << k;
    EXPECT_EQ(tick.frame.drive.settled, train[k].frame.drive.settled) << k;
    EXPECT_LT((tick.frame.mag_tesla - train[k].frame.mag_tesla).norm(), 1e-9) << k;
    on += tick.frame.drive.coil == 0 ? 1 : 0;
  }
  EXPECT_EQ(on, 8) << "60 ms at 120 Hz";
}

}  // namespace
}  // namespace limbcast::simulation
