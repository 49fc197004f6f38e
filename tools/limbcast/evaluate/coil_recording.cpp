#include "tools/limbcast/evaluate/coil_recording.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/filters/position/offline_smoother.hpp"
#include "common/simulation/magnetic_world.hpp"
#include "common/simulation/random.hpp"

namespace limbcast::tool {
namespace {

// Notation: E earth (the optical system's axes), S sensor; the emitter's axes are those of E.

using filters::FillKind;
using filters::PositionEstimate;

constexpr double kBefore_s = 5.0;
constexpr double kBeside_m = 0.15;
constexpr double kMagRate_hz = 120.0;

bool IsKnown(const PositionEstimate& estimate) {
  return estimate.fill == FillKind::kMeasured || estimate.fill == FillKind::kInertialSmoothed;
}

// The estimates of rows from `first` on, which moves to where the smoother begins; one each, until
// the smoother has a hole.
std::vector<PositionEstimate> TruthOf(const GapTrial& recording, std::size_t& first) {
  const auto smoothed =
      filters::SmoothOffline(filters::OpticalInertialConfig(), recording.samples, recording.markers)
          .estimates;
  std::vector<PositionEstimate> truth;
  while (!smoothed.empty() && first < recording.samples.size() &&
         recording.samples[first].measured_at < smoothed.front().at) {
    ++first;
  }
  std::size_t e = 0;
  for (std::size_t row = first; row < recording.samples.size(); ++row) {
    const Time at = recording.samples[row].measured_at;
    while (e < smoothed.size() && smoothed[e].at < at) {
      ++e;
    }
    if (e == smoothed.size() || smoothed[e].at != at || !IsKnown(smoothed[e])) {
      break;
    }
    truth.push_back(smoothed[e]);
  }
  return truth;
}

struct Source {
  Eigen::Vector3d p_earth_m;
  Eigen::Vector3d towards_sensor;  // the axis that points into the box
};

Source PlaceSource(const std::vector<PositionEstimate>& truth) {
  Eigen::Vector3d low = truth.front().p_earth_sensor_m;
  Eigen::Vector3d high = low;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  for (const PositionEstimate& estimate : truth) {
    low = low.cwiseMin(estimate.p_earth_sensor_m);
    high = high.cwiseMax(estimate.p_earth_sensor_m);
    place += estimate.p_earth_sensor_m / static_cast<double>(truth.size());
  }
  Eigen::Index thinnest = 0;
  static_cast<void>((high - low).minCoeff(&thinnest));
  place[thinnest] = low[thinnest] - kBeside_m;
  return {place, Eigen::Vector3d::Unit(thinnest)};
}

}  // namespace

std::optional<CoilTrial> MakeCoilTrial(const GapTrial& recording, CoilNoise noise,
                                       std::uint64_t seed) {
  const auto moving = std::find(recording.movement.begin(), recording.movement.end(), 1);
  const auto first_moving = static_cast<std::size_t>(moving - recording.movement.begin());
  const auto before = static_cast<std::size_t>(kBefore_s * recording.rate_hz);
  std::size_t first = first_moving > before ? first_moving - before : 0;
  const std::vector<PositionEstimate> truth = TruthOf(recording, first);
  if (first + truth.size() <= first_moving || first >= first_moving) {
    return std::nullopt;
  }
  const auto [p_source_m, towards_sensor] = PlaceSource(truth);
  CoilTrial trial;
  trial.name = recording.name;
  trial.noise = noise;
  trial.rate_hz = recording.rate_hz;
  trial.config.sigma_mag_tesla = SigmaOf_tesla(noise);
  trial.config.half_space = towards_sensor;
  const simulation::CoilPulseConfig pulses = PulsesOf(noise);
  const simulation::MagneticWorld world;
  const Eigen::Matrix3d G = DrawGradient_tesla_m(seed);
  const double mag_rate_hz = std::min(kMagRate_hz, recording.rate_hz);
  simulation::Random random(seed, "magnetometer");
  trial.ticks.reserve(truth.size());
  trial.scored.reserve(truth.size());
  for (std::size_t k = 0; k < truth.size(); ++k) {
    const sensing::MargSample& sample = recording.samples[first + k];
    const PositionEstimate& at = truth[k];
    const double t_s = static_cast<double>(k) / recording.rate_hz;
    simulation::CoilTick tick;
    tick.p_emitter_sensor_m = at.p_earth_sensor_m - p_source_m;
    tick.q_sensor_emitter = at.q_earth_sensor.conjugate();
    tick.frame.measured_at = sample.measured_at;
    tick.frame.gyro_rad_s = sample.gyro_rad_s.cast<double>();
    tick.frame.accel_m_s2 = sample.accel_m_s2.cast<double>();
    tick.frame.emitter_inertial = false;
    tick.frame.drive = simulation::StatedDrive(pulses, t_s);
    // Of the row before in the same arithmetic, or rounding makes one reading two.
    const auto reading_of = [&](std::size_t row) {
      return std::floor(static_cast<double>(row) / recording.rate_hz * mag_rate_hz);
    };
    const bool is_new = k == 0 || reading_of(k) > reading_of(k - 1);
    tick.frame.mag_valid = is_new;
    if (is_new) {
      Eigen::Vector3d field_E =
          world.At(at.p_earth_sensor_m) + G * tick.p_emitter_sensor_m.array().sin().matrix();
      const simulation::CoilCurrent current = simulation::TrueCurrent(pulses, t_s);
      if (current.coil >= 0) {
        field_E += sensing::CoilField(trial.config.source, current.coil, current.current_a,
                                      tick.p_emitter_sensor_m)
                       .field_tesla;
      }
      tick.frame.mag_tesla =
          tick.q_sensor_emitter * field_E + SigmaOf_tesla(noise) * random.Gaussian3();
    }
    trial.ticks.push_back(tick);
    trial.scored.push_back(recording.movement[first + k]);
  }
  return trial;
}

}  // namespace limbcast::tool
