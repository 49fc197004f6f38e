#include "services/gateway/drivers/simulator/simulator_config.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <string>

namespace limbcast::gateway {
namespace {

struct Parsed {
  SimulatorConfig config;
  Status status;
};

Parsed Parse(const std::string& text) {
  const auto file = config::ConfigFile::Parse(text, "test.toml");
  EXPECT_TRUE(file.ok());
  Parsed parsed;
  parsed.config = ReadSimulatorConfig(file->Get("simulator"));
  parsed.status = file->Finish();
  return parsed;
}

TEST(SimulatorConfigTest, ReadsEveryKey) {
  const Parsed parsed = Parse(R"(
[simulator]
persons = 3
rate_hz = 250
sensors = "reduced15"
duration_s = 12.5
seed = 99
noise = "poor"
mounting = "rough"
motion = "standing"
n_pose_s = 2
facing_deg = 90
height_m = 1.6
spacing_m = 5
iron = false
magnetometer = false
serial_prefix = "left"
[simulator.faults]
not_finite_rate = 0.01
gap_rate = 0.02
gap_ticks = 7
[[simulator.faults.list]]
tick = 400
body = 2
segment = "left_hand"
fault = "duplicate"
)");
  ASSERT_TRUE(parsed.status.ok()) << parsed.status.error().message;
  const SimulatorConfig& config = parsed.config;
  EXPECT_EQ(config.persons, 3U);
  EXPECT_EQ(config.rate_hz, 250.0);
  EXPECT_EQ(config.sensors, simulation::SensorSet::kReduced15);
  EXPECT_EQ(config.duration_s, 12.5);
  EXPECT_EQ(config.seed, 99U);
  EXPECT_EQ(config.noise, simulation::NoisePreset::kPoor);
  EXPECT_EQ(config.mounting, simulation::MountingStyle::kRough);
  EXPECT_EQ(config.motion, SimulatedMotion::kStanding);
  EXPECT_NEAR(config.facing_rad, std::numbers::pi / 2.0, 1e-12);
  EXPECT_FALSE(config.iron);
  EXPECT_FALSE(config.magnetometer);
  EXPECT_EQ(config.serial_prefix, "left");
  EXPECT_EQ(config.faults.rate[static_cast<std::size_t>(Fault::kGap)], 0.02);
  EXPECT_EQ(config.faults.gap_ticks, 7U);
  ASSERT_EQ(config.faults.list.size(), 1U);
  EXPECT_EQ(config.faults.list[0].tick, 400U);
  EXPECT_EQ(config.faults.list[0].segment, body::Segment::kLeftHand);
  EXPECT_EQ(config.faults.list[0].fault, Fault::kDuplicate);
}

TEST(SimulatorConfigTest, RefusalsNameTheKey) {
  for (const auto& [text, key] :
       {std::pair{"persons = 0", "persons"}, std::pair{"rate_hz = 5000", "rate_hz"},
        std::pair{"sensors = \"most\"", "sensors"}, std::pair{"noise = \"loud\"", "noise"},
        std::pair{"height_m = 3", "height_m"}, std::pair{"speed = 3", "speed"},
        std::pair{"faults.gap_rate = 2.0", "gap_rate"}}) {
    const Parsed parsed = Parse("[simulator]\n" + std::string(text));
    ASSERT_FALSE(parsed.status.ok()) << text;
    EXPECT_NE(parsed.status.error().message.find(key), std::string::npos)
        << parsed.status.error().message;
  }
  const Parsed parsed =
      Parse("[[simulator.faults.list]]\ntick = 1\nsegment = \"tail\"\nfault = \"gap\"");
  ASSERT_FALSE(parsed.status.ok());
  EXPECT_NE(parsed.status.error().message.find("tail"), std::string::npos);
  EXPECT_FALSE(Parse("[[simulator.faults.list]]\nsegment = \"\"").status.ok()) << "no segment";
}

TEST(SimulatorConfigTest, ValidateHoldsTheSameRanges) {
  EXPECT_TRUE(Validate(SimulatorConfig{}).ok());
  SimulatorConfig config;
  config.rate_hz = 0.0;
  EXPECT_NE(Validate(config).error().message.find("simulator.rate_hz"), std::string::npos);
  config = {};
  config.serial_prefix = "a prefix much too long";
  EXPECT_NE(Validate(config).error().message.find("serial_prefix"), std::string::npos);
}

}  // namespace
}  // namespace limbcast::gateway
