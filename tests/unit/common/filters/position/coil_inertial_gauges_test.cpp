// What the source's own magnetometer gives, and when it is not to be heard.
#include <gtest/gtest.h>

#include <cmath>

#include "common/filters/position/coil_inertial_filter.hpp"
#include "common/math/rotation.hpp"
#include "tests/unit/common/filters/position/coil_scene.hpp"

namespace limbcast::filters {
namespace {

using Index = CoilInertialIndex;
using simulation::CoilTick;

constexpr double kSeconds = 25.0;
constexpr double kFrom_s = 5.0;

std::vector<CoilTick> Swing(bool magnetometer) {
  simulation::CoilStreamConfig stream = SwingStream(true, simulation::ThesisPulses());
  stream.emitter_magnetometer = magnetometer;
  return simulation::SimulateCoil(stream, kSeconds, 21);
}

CoilInertialFilter MakeFilter(const CoilInertialConfig& config = SwingConfig()) {
  auto made = CoilInertialFilter::Make(config);
  EXPECT_TRUE(made);
  return *made;
}

struct Figures {
  double rms_m = 0.0;
  double rms_rad = 0.0;
  double sigma_heading_rad = 0.0;  // at last, of θ_s − θ_m about the vertical
  CoilVector last = CoilVector::Zero();
};

Figures Play(CoilInertialFilter filter, const std::vector<CoilTick>& ticks) {
  Figures figures;
  int count = 0;
  for (const CoilTick& tick : ticks) {
    filter.Update(tick.frame);
    if (ToSeconds(tick.frame.measured_at.time_since_epoch()) < kFrom_s) {
      continue;
    }
    ++count;
    const CoilInertialState& state = filter.state();
    figures.rms_m += (state.p_emitter_sensor_m() - tick.p_emitter_sensor_m).squaredNorm();
    figures.rms_rad +=
        std::pow(math::AngleBetween_rad(state.q_sensor_emitter(), tick.q_sensor_emitter), 2);
  }
  figures.rms_m = std::sqrt(figures.rms_m / count);
  figures.rms_rad = std::sqrt(figures.rms_rad / count);
  const CoilCovariance& P = filter.covariance();
  constexpr int kS = Index::kSensorTheta + 2;
  constexpr int kM = Index::kEmitterTheta + 2;
  figures.sigma_heading_rad = std::sqrt(P(kS, kS) + P(kM, kM) - 2.0 * P(kS, kM));
  figures.last = Minus(filter.state(), {});
  return figures;
}

TEST(CoilInertialGaugesTest, TheSourcesCompassTiesItsHeadingToTheSensors) {
  const Figures with = Play(MakeFilter(), Swing(true));
  const Figures without = Play(MakeFilter(), Swing(false));
  EXPECT_LT(with.sigma_heading_rad, 0.8 * without.sigma_heading_rad);
  EXPECT_LT(with.rms_m, without.rms_m);
  EXPECT_LT(with.rms_rad, 0.0175);
}

TEST(CoilInertialGaugesTest, ItIsNotHeardWhileACoilIsOnOrHasJustBeen) {
  const std::vector<CoilTick> ticks = Swing(true);
  std::vector<CoilTick> shaken = ticks;
  Time on_at = ticks.front().frame.measured_at;
  for (CoilTick& tick : shaken) {
    sensing::CoilFrame& frame = tick.frame;
    if (frame.drive.coil >= 0 || !frame.drive.settled) {
      on_at = frame.measured_at;
    }
    if (ToSeconds(frame.measured_at - on_at) < SwingConfig().emitter_quiet_s) {
      frame.emitter_mag_tesla = {3e-4, -2e-4, 1e-4};
    }
  }
  EXPECT_EQ(Play(MakeFilter(), shaken).last, Play(MakeFilter(), ticks).last);
}

TEST(CoilInertialGaugesTest, WithoutTheGradientItIsNotHeardAtAll) {
  CoilInertialConfig config = SwingConfig();
  config.estimate_gradient = false;
  EXPECT_EQ(Play(MakeFilter(config), Swing(true)).last,
            Play(MakeFilter(config), Swing(false)).last);
}

TEST(CoilInertialGaugesTest, NoReadingOrAClippedOneIsLeftOut) {
  std::vector<CoilTick> ticks = Swing(true);
  for (CoilTick& tick : ticks) {
    tick.frame.emitter_mag_valid = false;
  }
  EXPECT_EQ(Play(MakeFilter(), ticks).last, Play(MakeFilter(), Swing(false)).last);
  for (CoilTick& tick : ticks) {
    tick.frame.emitter_mag_valid = true;
    tick.frame.emitter_mag_tesla.y() = std::nan("");
  }
  EXPECT_EQ(Play(MakeFilter(), ticks).last, Play(MakeFilter(), Swing(false)).last);
}

// A magnet near the source: what it says is nonsense, and the pulses say where the sensor is.
TEST(CoilInertialGaugesTest, AMagnetAtTheSourceDoesNotLoseTheTrack) {
  std::vector<CoilTick> ticks = Swing(true);
  for (CoilTick& tick : ticks) {
    if (ToSeconds(tick.frame.measured_at.time_since_epoch()) > 12.0) {
      tick.frame.emitter_mag_tesla += Eigen::Vector3d(20e-6, 0.0, 0.0);
    }
  }
  CoilInertialFilter filter = MakeFilter();
  double worst_m = 0.0;
  for (const CoilTick& tick : ticks) {
    filter.Update(tick.frame);
    if (ToSeconds(tick.frame.measured_at.time_since_epoch()) > kFrom_s) {
      worst_m =
          std::max(worst_m, (filter.state().p_emitter_sensor_m() - tick.p_emitter_sensor_m).norm());
    }
  }
  EXPECT_EQ(filter.losses(), 0);
  EXPECT_LT(worst_m, 0.06);
}

}  // namespace
}  // namespace limbcast::filters
