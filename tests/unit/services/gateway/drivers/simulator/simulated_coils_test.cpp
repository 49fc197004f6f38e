#include "services/gateway/drivers/simulator/simulated_coils.hpp"

#include <gtest/gtest.h>

#include "common/config/config_file.hpp"
#include "services/gateway/drivers/simulator/simulator_driver.hpp"

namespace limbcast::gateway {
namespace {

SimulatorConfig WithCoils(std::uint32_t persons = 1) {
  SimulatorConfig config;
  config.persons = persons;
  config.spacing_m = 1.5;
  config.noise = simulation::NoisePreset::kIdeal;
  config.iron = false;
  config.motion = SimulatedMotion::kStanding;
  config.coils.source = body::Segment::kPelvis;
  config.coils.mag_noise_tesla = 0.0;
  return config;
}

TEST(SimulatedCoilsTest, ReadsItsSection) {
  const auto file = config::ConfigFile::Parse(
      "[c]\nsource = \"t8\"\nsensors = [\"left_hand\"]\nmag_noise_nt = 50\nslots = 3\n", "c.toml");
  const SimulatedCoilsConfig config = ReadSimulatedCoils(file->Get("c"), {});
  EXPECT_TRUE(file->Finish());
  EXPECT_EQ(config.source, body::Segment::kT8);
  EXPECT_EQ(config.sensors, std::vector{body::Segment::kLeftHand});
  EXPECT_DOUBLE_EQ(config.mag_noise_tesla, 50e-9);
  EXPECT_DOUBLE_EQ(config.cycle_s(), 0.9);
}

TEST(SimulatedCoilsTest, ASegmentThatIsNoneIsNamed) {
  const auto file = config::ConfigFile::Parse("[c]\nsource = \"belly\"\n", "c.toml");
  static_cast<void>(ReadSimulatedCoils(file->Get("c"), {}));
  const Status status = file->Finish();
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().message.find("'belly'"), std::string::npos) << status.error().message;
}

TEST(SimulatedCoilsTest, APulseThatDoesNotFitItsSlotIsRefused) {
  SimulatedCoilsConfig config{.source = body::Segment::kPelvis};
  EXPECT_TRUE(Validate(config));
  config.plateau_s = 0.05;
  const Status status = Validate(config);
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().message.find("slot_s"), std::string::npos) << status.error().message;
}

TEST(SimulatedCoilsTest, CoilsOnASegmentWithoutSensorAreRefused) {
  SimulatorConfig config = WithCoils();
  config.coils.source = body::Segment::kL5;
  const auto driver = SimulatorDriver::Make(config);
  ASSERT_FALSE(driver);
  EXPECT_NE(driver.error().message.find("simulator.coils.source: l5 carries no sensor"),
            std::string::npos)
      << driver.error().message;
}

TEST(SimulatedCoilsTest, TwoPeopleNeverPulseAtOnce) {
  const SimulatedCoilsConfig config{.source = body::Segment::kPelvis};
  const auto first = PulsesOf(config, 0, 1);
  const auto second = PulsesOf(config, 1, 2);
  int on = 0;
  for (int k = 0; k < 20'000; ++k) {
    const double t_s = 0.001 * k;
    const auto a = simulation::StatedDrive(first, t_s);
    const auto b = simulation::StatedDrive(second, t_s);
    EXPECT_FALSE((a.coil >= 0 || !a.settled) && (b.coil >= 0 || !b.settled)) << t_s;
    on += a.coil >= 0 ? 1 : 0;
  }
  EXPECT_NEAR(on / 20'000.0, 0.3, 0.02);
}

// Where a pulse is on, the magnetometers show it, each by the exact field at its true place.
TEST(SimulatedCoilsTest, SensorsFeelTheFieldOfTheCoilThatIsOn) {
  const auto with = SimulatorDriver::Make(WithCoils());
  SimulatorConfig quiet = WithCoils();
  quiet.coils.source.reset();
  const auto without = SimulatorDriver::Make(quiet);
  ASSERT_TRUE(with && without);
  Batch a;
  Batch b;
  int pulses = 0;
  for (int tick = 0; tick < 200; ++tick) {
    ASSERT_TRUE((*with)->Next(a) && (*without)->Next(b));
    ASSERT_EQ(a.coil_drives.size(), 1U);
    const sensing::CoilDrive drive = a.coil_drives[0].drive;
    if (drive.coil < 0 || !drive.settled) {
      continue;
    }
    ++pulses;
    EXPECT_EQ(a.truth[0].sensor_uid, a.coil_drives[0].source_uid);
    for (std::size_t i = 1; i < a.marg.size(); ++i) {
      const Eigen::Vector3d p_M = a.truth[0].q_earth_sensor.conjugate() *
                                  (a.truth[i].p_earth_sensor_m - a.truth[0].p_earth_sensor_m);
      const Eigen::Vector3d field_E =
          a.truth[0].q_earth_sensor *
          sensing::CoilField({}, drive.coil, drive.current_a, p_M).field_tesla;
      const Eigen::Vector3d felt_E =
          a.truth[i].q_earth_sensor * (a.marg[i].mag_tesla - b.marg[i].mag_tesla).cast<double>();
      // Scale errors of the magnetometer, rounding to 5 nT, a current that has come to 0.2 %.
      EXPECT_LT((felt_E - field_E).norm(), 0.005 * field_E.norm() + 60e-9) << i;
    }
  }
  EXPECT_GT(pulses, 20);
}

TEST(SimulatedCoilsTest, TheSourceIsDescribedAsAGatewayNeedsIt) {
  const auto driver = SimulatorDriver::Make(WithCoils(2));
  ASSERT_TRUE(driver);
  const auto& sources = (*driver)->Describe().coil_sources;
  ASSERT_EQ(sources.size(), 2U);
  EXPECT_EQ(sources[0].slot, 0U);
  EXPECT_EQ(sources[1].slot, 1U);
  EXPECT_EQ(sources[1].body_id, BodyId{2});
  EXPECT_EQ(sources[0].sensors.size(), 4U);
  EXPECT_EQ((*driver)->Describe().bodies[1].coil_slot, 2U);
}

}  // namespace
}  // namespace limbcast::gateway
