#include "tools/limbcast/evaluate/coil_trial.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/base/expects.hpp"
#include "common/filters/position/coil_loose_filter.hpp"
#include "common/filters/position/coil_smoothing.hpp"
#include "common/math/rotation.hpp"
#include "common/simulation/random.hpp"
#include "tools/limbcast/evaluate/coil_score.hpp"

namespace limbcast::tool {
namespace {

using simulation::CoilTick;

constexpr double kLag_s = 0.6;
constexpr double kGradient_tesla_m = 0.3e-6;  // of a room, each element

std::size_t TickAt(const CoilTrial& trial, Time at) {
  const double k = ToSeconds(at - trial.ticks.front().frame.measured_at) * trial.rate_hz;
  return static_cast<std::size_t>(std::lround(k));
}

// Gyro attitudes for the magnetic tracker: the filter's own inertial path is not used.
CoilFigure MagneticOnly(const CoilTrial& trial) {
  constexpr int kBackgroundAfter = 10;
  const auto& ticks = trial.ticks;
  filters::CoilPulseCollector collector(trial.config.sigma_mag_tesla, kBackgroundAfter);
  filters::CoilPath path;
  CoilScore score;
  filters::HemisphereRule rule;
  rule.half_space = trial.config.half_space;
  rule.boundary_rad = 0.0;
  filters::CoilPoseConfig config;
  config.accept_cost = 1e9;  // motion between the pulses is in the cost: it is what is measured
  config.max_sigma_m = 1e9;
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    const sensing::CoilFrame& frame = ticks[k].frame;
    if (k > 0) {
      const sensing::CoilFrame& last = ticks[k - 1].frame;
      const double half_s = 0.5 / trial.rate_hz;
      path.q_earth_sensor =
          (path.q_earth_sensor * math::ExpSO3(half_s * (last.gyro_rad_s + frame.gyro_rad_s)))
              .normalized();
      if (frame.emitter_inertial) {
        path.q_earth_emitter =
            (path.q_earth_emitter *
             math::ExpSO3(half_s * (last.emitter_gyro_rad_s + frame.emitter_gyro_rad_s)))
                .normalized();
      }
    }
    if (!collector.Update(frame, path)) {
      continue;
    }
    const auto burst = collector.Burst();
    const std::size_t middle = TickAt(trial, collector.pulses()[1].middle_at);
    if (!burst || trial.scored[middle] == 0) {
      continue;
    }
    const filters::CoilPose pose =
        filters::SolveCoilPose(config, trial.config.source, *burst, rule);
    score.Add(pose.p_emitter_sensor_m, pose.q_sensor_emitter, ticks[middle]);
  }
  return score.Figure();
}

// Errors of a filter's estimates, and how it kept to its track.
struct ForwardScore {
  CoilScore errors;
  double nees = 0.0;
  double tracked = 0.0;
  double scored = 0.0;

  void Add(const filters::CoilEstimate& now, const CoilTick& truth) {
    scored += 1.0;
    if (!now.valid) {
      return;
    }
    tracked += 1.0;
    errors.Add(now.p_emitter_sensor_m, now.q_sensor_emitter, truth);
    nees += (now.p_emitter_sensor_m - truth.p_emitter_sensor_m).squaredNorm() /
            (now.sigma_m * now.sigma_m);
  }
  [[nodiscard]] CoilTracking Tracking(int losses) const {
    return {tracked / std::max(1.0, scored), losses, nees / std::max(1.0, tracked)};
  }
};

template <typename Filter>
filters::CoilEstimate EstimateNow(const Filter& filter, Time measured_at) {
  return filters::EstimateOf(filter.state(), filter.covariance(), measured_at,
                             filter.phase() == filters::CoilPhase::kTracking);
}

CoilFigure Loose(const CoilTrial& trial, CoilTracking& tracking) {
  auto filter = filters::LooseCoilFilter::Make(trial.config);
  Expects(filter.ok(), "a valid configuration");
  ForwardScore score;
  for (std::size_t k = 0; k < trial.ticks.size(); ++k) {
    const CoilTick& tick = trial.ticks[k];
    filter->Update(tick.frame);
    if (trial.scored[k] != 0) {
      score.Add(EstimateNow(*filter, tick.frame.measured_at), tick);
    }
  }
  tracking = score.Tracking(filter->losses());
  return score.errors.Figure();
}

}  // namespace

std::vector<CoilCase> CoilCasesOf(const std::vector<CoilExperiment>& experiments,
                                  const std::string& only) {
  std::vector<CoilCase> cases;
  for (const CoilNoise noise : kCoilNoises) {
    for (std::size_t i = 0; i < experiments.size(); ++i) {
      if (experiments[i].name.find(only) != std::string::npos) {
        cases.push_back({noise, i});
      }
    }
  }
  return cases;
}

double SigmaOf_tesla(CoilNoise noise) { return noise == CoilNoise::kThesis ? 50e-9 : 15e-9; }

simulation::CoilPulseConfig PulsesOf(CoilNoise noise) {
  return noise == CoilNoise::kThesis ? simulation::ThesisPulses() : simulation::BipolarPulses();
}

Eigen::Matrix3d DrawGradient_tesla_m(simulation::Random& random) {
  Eigen::Matrix3d G = Eigen::Matrix3d::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    G.row(i) = kGradient_tesla_m * random.Gaussian3().transpose();
  }
  G = (0.5 * (G + G.transpose())).eval();
  return G - G.trace() / 3.0 * Eigen::Matrix3d::Identity();
}

Eigen::Matrix3d DrawGradient_tesla_m(std::uint64_t seed) {
  simulation::Random random(seed, "gradient");
  return DrawGradient_tesla_m(random);
}

simulation::CoilStreamConfig MakeCoilStream(const CoilExperiment& experiment, CoilNoise noise,
                                            std::uint64_t seed) {
  simulation::CoilStreamConfig stream;
  stream.pulses = PulsesOf(noise);
  stream.sensor = experiment.sensor;
  stream.emitter = experiment.emitter;
  stream.emitter_inertial = experiment.emitter_inertial;
  stream.errors = simulation::CoilSensorErrors(SigmaOf_tesla(noise));
  stream.gradient_tesla_m = DrawGradient_tesla_m(seed);
  return stream;
}

filters::CoilInertialConfig MakeCoilFilter(const CoilExperiment& experiment, CoilNoise noise) {
  filters::CoilInertialConfig config;
  config.sigma_mag_tesla = SigmaOf_tesla(noise);
  config.half_space = experiment.half_space;
  config.walk_background_tesla_rts = experiment.walk_background_tesla_rts;
  config.start_sigma_gradient_tesla_m = kGradient_tesla_m;
  config.mag_calibration_error = 1e-3;
  // The inertial units of CoilSensorErrors, with something in reserve; scale and misalignment are
  // 0.2 % each.
  config.start_sigma_accel_matrix = 1.2e-3;
  config.start_sigma_gyro_matrix = 1.2e-3;
  config.inertial.sigma_accel_m_s2_rthz = 2.5e-3;
  config.inertial.sigma_gyro_rad_s_rthz = 9e-4;
  config.inertial.walk_accel_bias_m_s3_rthz = 3e-4;
  config.inertial.walk_gyro_bias_rad_s2_rthz = 5e-5;
  config.inertial.k_accel = 3e-3;
  config.inertial.k_rate = 2e-3;
  config.relative_field_error = 3e-3;
  return config;
}

CoilTrial MakeCoilTrial(const CoilExperiment& experiment, CoilNoise noise, std::uint64_t seed) {
  const simulation::CoilStreamConfig stream = MakeCoilStream(experiment, noise, seed);
  filters::CoilInertialConfig filter = MakeCoilFilter(experiment, noise);
  filter.source = stream.source;
  return MakeCoilTrial(experiment, noise, stream, filter, seed);
}

CoilTrial MakeCoilTrial(const CoilExperiment& experiment, CoilNoise noise,
                        const simulation::CoilStreamConfig& stream,
                        const filters::CoilInertialConfig& filter, std::uint64_t seed) {
  CoilTrial trial;
  trial.name = experiment.name;
  trial.noise = noise;
  trial.rate_hz = stream.rate_hz;
  trial.ticks = simulation::SimulateCoil(stream, experiment.duration_s, seed);
  trial.scored.reserve(trial.ticks.size());
  for (const CoilTick& tick : trial.ticks) {
    const double at_s = ToSeconds(tick.frame.measured_at.time_since_epoch());
    trial.scored.push_back(at_s >= kCoilScoredFrom_s ? 1 : 0);
  }
  trial.config = filter;
  return trial;
}

CoilLiveFigures EvaluateLive(
    const CoilTrial& trial,
    const std::function<void(const filters::CoilInertialFilter&, Time)>& on_update) {
  auto filter = filters::CoilInertialFilter::Make(trial.config);
  Expects(filter.ok(), "a valid configuration");
  filters::CoilFixedLag fixed_lag(kLag_s, trial.rate_hz);
  ForwardScore forward;
  CoilScore lag_score;
  CoilLiveFigures live;
  for (std::size_t k = 0; k < trial.ticks.size(); ++k) {
    const CoilTick& tick = trial.ticks[k];
    const Time now_at = tick.frame.measured_at;
    filter->Update(tick.frame);
    if (on_update) {
      on_update(*filter, now_at);
    }
    filters::CoilEstimate lagged;
    if (fixed_lag.Update(*filter, now_at, lagged) && lagged.valid) {
      const std::size_t then = TickAt(trial, lagged.measured_at);
      if (trial.scored[then] != 0) {
        lag_score.Add(lagged.p_emitter_sensor_m, lagged.q_sensor_emitter, trial.ticks[then]);
      }
    }
    if (trial.scored[k] != 0) {
      live.mean_range_m += tick.p_emitter_sensor_m.norm();
      forward.Add(EstimateNow(*filter, now_at), tick);
    }
  }
  live.mean_range_m /= std::max(1.0, forward.scored);
  live.forward = forward.errors.Figure();
  live.lagged = lag_score.Figure();
  live.tracking = forward.Tracking(filter->losses());
  return live;
}

CoilFollowed FollowTrial(const CoilTrial& trial) {
  filters::CoilIntervalSmoother smoother;
  CoilFollowed followed;
  followed.live = EvaluateLive(
      trial, [&](const filters::CoilInertialFilter& filter, Time at) { smoother.Add(filter, at); });
  const auto smoothed = smoother.Smooth();
  CoilScore smoothed_score;
  for (std::size_t k = 0; k < trial.ticks.size(); ++k) {
    if (smoothed[k].valid && trial.scored[k] != 0) {
      smoothed_score.Add(smoothed[k].p_emitter_sensor_m, smoothed[k].q_sensor_emitter,
                         trial.ticks[k]);
    }
  }
  followed.smoothed = smoothed_score.Figure();
  return followed;
}

CoilResult EvaluateTrial(const CoilTrial& trial) {
  const CoilFollowed followed = FollowTrial(trial);
  const CoilLiveFigures& live = followed.live;
  CoilResult result;
  result.experiment = trial.name;
  result.noise = trial.noise;
  result.mean_range_m = live.mean_range_m;
  result.forward = live.tracking;
  const auto figure = [&](CoilMethod method) -> CoilFigure& {
    return result.figures[static_cast<std::size_t>(method)];
  };
  figure(CoilMethod::kMagneticOnly) = MagneticOnly(trial);
  figure(CoilMethod::kLoose) = Loose(trial, result.loose);
  figure(CoilMethod::kForward) = live.forward;
  figure(CoilMethod::kFixedLag) = live.lagged;
  figure(CoilMethod::kSmoothed) = followed.smoothed;
  return result;
}

CoilResult EvaluateCoil(const CoilExperiment& experiment, CoilNoise noise, std::uint64_t seed) {
  return EvaluateTrial(MakeCoilTrial(experiment, noise, seed));
}

}  // namespace limbcast::tool
