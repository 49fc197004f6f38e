#include "common/sensing/coil_tones.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace limbcast::sensing {
namespace {

using ::testing::HasSubstr;

TEST(CoilTonesTest, CurrentsAreSinesOfTheirOwnFrequency) {
  CoilTones tones;
  tones.frequency_hz = {20.0, 30.0, 40.0};
  tones.amplitude_a = 0.5;
  EXPECT_EQ(ToneCurrents_a(tones, 0.0), Eigen::Vector3d::Zero());
  // A quarter of the first period: 90, 135 and 180 degrees.
  const Eigen::Vector3d i_a = ToneCurrents_a(tones, 0.0125);
  EXPECT_NEAR(i_a.x(), 0.5, 1e-12);
  EXPECT_NEAR(i_a.y(), 0.5 / std::numbers::sqrt2, 1e-12);
  EXPECT_NEAR(i_a.z(), 0.0, 1e-12);
}

// What "as much heat as with the thesis' pulses" means: the mean square of the current.
TEST(CoilTonesTest, HeatAsMuchAsThePulsesByDefault) {
  const CoilTones tones;
  double square_a2 = 0.0;
  constexpr int kSamples = 200000;
  for (int k = 0; k < kSamples; ++k) {
    square_a2 += ToneCurrents_a(tones, 10.0 * k / kSamples).squaredNorm() / kSamples;
  }
  EXPECT_NEAR(square_a2, 3.0 * (0.060 / 0.600) * 1.5 * 1.5, 0.005);
}

TEST(CoilTonesTest, RefusesWhatAMagnetometerCannotTellApart) {
  const auto refusal = [](const CoilTones& tones, double rate_hz) {
    const Status valid = Validate(tones, rate_hz);
    return valid ? std::string("accepted") : valid.error().message;
  };
  const CoilTones good;
  EXPECT_EQ(refusal(good, 120.0), "accepted");
  EXPECT_THAT(refusal(good, 99.0),
              HasSubstr("tones.frequency_hz[2] must be in [15.000000, 39.600000]"));
  CoilTones tones = good;
  tones.frequency_hz[0] = 14.0;
  EXPECT_THAT(refusal(tones, 120.0), HasSubstr("tones.frequency_hz[0]"));
  tones = good;
  tones.frequency_hz = {18.0, 40.0, 27.0};
  EXPECT_THAT(refusal(tones, 120.0),
              HasSubstr("tones.frequency_hz apart by must be in [10.000000, inf]"));
  tones.frequency_hz = {40.0, 30.0, 20.0};
  EXPECT_EQ(refusal(tones, 120.0), "accepted") << "exactly 2 / T, in any order";
  tones = good;
  tones.amplitude_a = 0.0;
  EXPECT_THAT(refusal(tones, 120.0), HasSubstr("tones.amplitude_a"));
  tones = good;
  tones.window_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(tones, 120.0), HasSubstr("tones.window_s"));
}

}  // namespace
}  // namespace limbcast::sensing
