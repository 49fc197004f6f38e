#include "common/filters/position/coil_pulse_collector.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "common/filters/position/coil_pose_solver.hpp"
#include "common/math/rotation.hpp"
#include "common/sensing/coil_tones.hpp"
#include "common/simulation/coil_pulses.hpp"

namespace limbcast::filters {
namespace {

const Eigen::Vector3d kEarth_tesla(0.0, 19e-6, -45e-6);
const Eigen::Vector3d kCoil_tesla(1e-6, -2e-6, 0.5e-6);  // earth frame, at full current

// A sensor that turns at 2 rad/s.
CoilPath TurnedAt(double t_s) {
  CoilPath path;
  path.q_earth_sensor = math::ExpSO3(2.0 * t_s * Eigen::Vector3d(0.6, 0.0, 0.8));
  return path;
}

sensing::CoilFrame FrameAt(double t_s) {
  sensing::CoilFrame frame;
  frame.measured_at = TimeFromNanoseconds(0) + DurationFromSeconds(t_s);
  return frame;
}

// Pulses on that sensor; the field is the same for all coils. Returns pulses seen.
int Play(const simulation::CoilPulseConfig& pulses, double seconds, CoilPulseCollector& collector) {
  int seen = 0;
  for (int k = 0; k < static_cast<int>(120.0 * seconds); ++k) {
    const double t_s = k / 120.0;
    const CoilPath path = TurnedAt(t_s);
    sensing::CoilFrame frame = FrameAt(t_s);
    frame.drive = simulation::StatedDrive(pulses, t_s);
    const simulation::CoilCurrent current = simulation::TrueCurrent(pulses, t_s);
    frame.mag_tesla = path.q_earth_sensor.conjugate() *
                      (kEarth_tesla + current.current_a / pulses.current_a * kCoil_tesla);
    seen += collector.Update(frame, path) ? 1 : 0;
  }
  return seen;
}

TEST(CoilPulseCollectorTest, RemovesTheBackgroundOfATurningSensor) {
  for (const auto& pulses : {simulation::ThesisPulses(), simulation::BipolarPulses()}) {
    CoilPulseCollector collector(50e-9, 3);
    EXPECT_EQ(Play(pulses, 1.75, collector), 4);
    EXPECT_EQ(collector.size(), 3U);
    EXPECT_EQ(collector.newest().coil, 0);
    EXPECT_LT((collector.newest().field_earth_tesla - kCoil_tesla).norm(), 3e-9);
    EXPECT_LT((collector.background_earth_tesla() - kEarth_tesla).norm(), 1e-9);
  }
}

TEST(CoilPulseCollectorTest, StatesTheNoiseOfTheAmplitude) {
  CoilPulseCollector collector(50e-9, 10);
  Play(simulation::ThesisPulses(), 1.75, collector);
  // Six samples of a plateau and twenty of the background, or one more or less.
  EXPECT_NEAR(collector.newest().sigma_tesla, 50e-9 * std::sqrt(1.0 / 6.0 + 1.0 / 20.0), 2.5e-9);
  CoilPulseCollector bipolar(50e-9, 3);
  Play(simulation::BipolarPulses(), 1.75, bipolar);
  EXPECT_LT(bipolar.newest().sigma_tesla, 50e-9 / std::sqrt(2.0) + 1e-12);
}

TEST(CoilPulseCollectorTest, ABurstIsAtTheMiddleOfTheSecondPulse) {
  CoilPulseCollector collector(50e-9, 3);
  Play(simulation::ThesisPulses(), 1.35, collector);
  EXPECT_FALSE(collector.Burst());
  collector.Clear();
  Play(simulation::ThesisPulses(), 1.75, collector);
  const auto burst = collector.Burst();
  ASSERT_TRUE(burst);
  EXPECT_LT(((*burst)[1].R_pulse_reference_sensor - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_NEAR((*burst)[0].time_from_reference_s, -0.2, 1e-6);
  EXPECT_NEAR((*burst)[2].time_from_reference_s, 0.2, 1e-6);
}

// The same sensor, with three tones at once whose fields differ. Returns windows seen.
int PlayTones(double seconds, bool clipped, CoilPulseCollector& collector) {
  const sensing::CoilTones tones;
  int seen = 0;
  for (int k = 0; k < static_cast<int>(120.0 * seconds); ++k) {
    const double t_s = k / 120.0;
    const CoilPath path = TurnedAt(t_s);
    sensing::CoilFrame frame = FrameAt(t_s);
    frame.drive.coil = sensing::kAllCoils;
    frame.drive.current_a = tones.amplitude_a;
    frame.drive.tones_a = ToneCurrents_a(tones, t_s);
    const Eigen::Vector3d shares = frame.drive.tones_a / tones.amplitude_a;
    frame.mag_tesla =
        path.q_earth_sensor.conjugate() *
        (kEarth_tesla + (shares[0] - 2.0 * shares[1] + 0.5 * shares[2]) * kCoil_tesla);
    frame.mag_valid = !clipped || k % 5 != 0;
    seen += collector.Update(frame, path) ? 1 : 0;
  }
  return seen;
}

TEST(CoilPulseCollectorTest, AWindowOfTonesIsThreePulsesAtItsMiddle) {
  for (const bool clipped : {false, true}) {
    CoilPulseCollector collector(50e-9, 3, 0.2);
    EXPECT_EQ(PlayTones(1.0, clipped, collector), 4);
    const auto burst = collector.Burst();
    ASSERT_TRUE(burst);
    EXPECT_LT((collector.background_earth_tesla() - kEarth_tesla).norm(), 1e-12);
    for (std::size_t coil = 0; coil < 3; ++coil) {
      const CollectedPulse& pulse = collector.pulses()[coil];
      const double share = coil == 0 ? 1.0 : coil == 1 ? -2.0 : 0.5;
      EXPECT_EQ(pulse.coil, static_cast<int>(coil));
      EXPECT_EQ(pulse.current_a, sensing::CoilTones{}.amplitude_a);
      EXPECT_LT((pulse.field_earth_tesla - share * kCoil_tesla).norm(), 1e-12);
      EXPECT_EQ((*burst)[coil].time_from_reference_s, 0.0);
      // σ √(2/n) of a sine of unit amplitude (design/position.md section 7).
      const double samples = clipped ? 20.0 : 25.0;
      EXPECT_NEAR(pulse.sigma_tesla, 50e-9 * std::sqrt(2.0 / samples), 3e-9);
    }
  }
}

TEST(CoilPulseCollectorTest, AWindowWithTooFewReadingsSaysNothing) {
  CoilPulseCollector collector(50e-9, 3, 0.2);
  for (int k = 0; k < 60; ++k) {
    const double t_s = k / 120.0;
    sensing::CoilFrame frame = FrameAt(t_s);
    frame.drive.coil = sensing::kAllCoils;
    frame.drive.current_a = 1.0;
    frame.drive.tones_a = ToneCurrents_a(sensing::CoilTones{}, t_s);
    frame.mag_valid = k % 6 == 0;
    EXPECT_FALSE(collector.Update(frame, {}));
  }
  EXPECT_FALSE(collector.Burst());
}

}  // namespace
}  // namespace limbcast::filters
