#include "common/simulation/coil_pulses.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace limbcast::simulation {
namespace {

TEST(CoilPulsesTest, TheThesisHasThirtyPercentDuty) {
  const CoilPulseConfig config = ThesisPulses();
  int on = 0;
  for (int i = 0; i < 6000; ++i) {
    on += StatedDrive(config, config.begin_s + 0.001 * i).coil >= 0 ? 1 : 0;
  }
  EXPECT_NEAR(on / 6000.0, 0.3, 0.002);
  EXPECT_EQ(StatedDrive(config, 0.5).coil, -1);
}

TEST(CoilPulsesTest, CoilsComeInTurn) {
  const CoilPulseConfig config = ThesisPulses();
  for (int k = 0; k < 7; ++k) {
    EXPECT_EQ(StatedDrive(config, config.begin_s + 0.2 * k + 0.03).coil, k % 3);
    EXPECT_EQ(StatedDrive(config, config.begin_s + 0.2 * k + 0.1).coil, -1);
  }
}

TEST(CoilPulsesTest, SamplesAfterAnEdgeAreNotSettled) {
  const CoilPulseConfig config = BipolarPulses();
  const double begin_s = config.begin_s;
  EXPECT_FALSE(StatedDrive(config, begin_s + 0.008).settled);
  EXPECT_TRUE(StatedDrive(config, begin_s + 0.009).settled);
  EXPECT_FALSE(StatedDrive(config, begin_s + 0.018).settled);
  EXPECT_LT(StatedDrive(config, begin_s + 0.030).current_a, 0.0);
  EXPECT_TRUE(StatedDrive(config, begin_s + 0.030).settled);
  EXPECT_FALSE(StatedDrive(config, begin_s + 0.036).settled);
  EXPECT_TRUE(StatedDrive(config, begin_s + 0.044).settled);
}

TEST(CoilPulsesTest, ASettledCurrentIsTheStatedOneWithinATenthOfAPercent) {
  for (const CoilPulseConfig& config : {ThesisPulses(), BipolarPulses()}) {
    for (int i = 0; i < 3000; ++i) {
      const double t_s = 0.9 + 0.001 * i;
      const sensing::CoilDrive drive = StatedDrive(config, t_s);
      if (drive.settled) {
        EXPECT_NEAR(TrueCurrent(config, t_s).current_a, drive.current_a, 2e-3 * config.current_a)
            << t_s;
      }
    }
  }
}

TEST(CoilPulsesTest, AClockErrorMovesTheCurrentOnly) {
  CoilPulseConfig config = ThesisPulses();
  config.clock_error_s = 0.02;
  EXPECT_EQ(StatedDrive(config, config.begin_s + 0.015).coil, 0);
  EXPECT_NEAR(TrueCurrent(config, config.begin_s + 0.015).current_a, 0.0, 1e-9);
}

TEST(CoilPulsesTest, RangesAreChecked) {
  EXPECT_TRUE(Validate(ThesisPulses()));
  EXPECT_TRUE(Validate(BipolarPulses()));
  CoilPulseConfig config = ThesisPulses();
  config.plateau_s = 0.3;
  EXPECT_FALSE(Validate(config));
  config = ThesisPulses();
  config.current_a = std::nan("");
  EXPECT_FALSE(Validate(config));
}

}  // namespace
}  // namespace limbcast::simulation
