#include "common/sensing/coil_flags.hpp"

#include <gtest/gtest.h>

namespace limbcast::sensing {
namespace {

TEST(CoilFlagsTest, ADriveSurvivesTheFlagsOfASample) {
  for (int coil = -1; coil < 3; ++coil) {
    for (const double current_a : {1.5, -1.5}) {
      const CoilDrive drive{.coil = coil, .current_a = coil < 0 ? 0.0 : current_a};
      const CoilDrive back = CoilDriveOf(CoilFlagsOf(drive), 1.5);
      EXPECT_EQ(back.coil, drive.coil);
      EXPECT_EQ(back.current_a, drive.current_a);
      EXPECT_TRUE(back.settled);
    }
  }
}

TEST(CoilFlagsTest, WithoutAPulseTheMagnetometerShowsTheEarth) {
  EXPECT_EQ(CoilFlagsOf({}), 0U);
  EXPECT_TRUE(CoilDriveOf(kMagHeld | kProbe, 1.5).settled);
}

TEST(CoilFlagsTest, WhatIsNotSettledMeansNothingWhicheverCoilIsOn) {
  for (int coil = -1; coil < 3; ++coil) {
    const std::uint32_t flags = CoilFlagsOf({.coil = coil, .current_a = 1.0, .settled = false});
    EXPECT_EQ(flags, kCoilPulseActive);
    EXPECT_FALSE(CoilDriveOf(flags, 1.0).settled);
    EXPECT_EQ(CoilDriveOf(flags, 1.0).coil, -1);
  }
}

TEST(CoilFlagsTest, TwoCoilsAtOnceAreNoMeasurement) {
  EXPECT_FALSE(CoilDriveOf(kCoilPulseActive | kCoilXOn | kCoilZOn, 1.0).settled);
}

}  // namespace
}  // namespace limbcast::sensing
