#include "tools/limbcast/evaluate/coil_adaptive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <utility>

#include "common/base/expects.hpp"
#include "common/filters/position/coil_inertial_filter.hpp"
#include "common/filters/position/coil_pulse_planner.hpp"
#include "common/simulation/smooth_step.hpp"
#include "tools/limbcast/evaluate/coil_score.hpp"

namespace limbcast::tool {
namespace {

constexpr double kMmPerM = 1e3;
constexpr double kDegPerRad = 180.0 / std::numbers::pi;

filters::CoilPulsePlanner MakePlanner(const simulation::CoilStreamConfig& stream,
                                      const filters::CoilInertialConfig& filter) {
  filters::CoilPlannerConfig config;
  config.pulse_s = simulation::PulseLength_s(stream.pulses);
  // The useful part of each plateau.
  const double useful_s =
      (stream.pulses.bipolar ? 2.0 : 1.0) * (stream.pulses.plateau_s - stream.pulses.settling_s);
  config.samples = std::max(1, static_cast<int>(useful_s * stream.rate_hz));
  config.current_a = stream.pulses.current_a;
  auto planner = filters::CoilPulsePlanner::Make(config, filter);
  Expects(planner.ok(), "a valid plan");
  return *planner;
}

class Run {
 public:
  Run(const CoilExperiment& experiment, const simulation::CoilStreamConfig& config,
      const filters::CoilInertialConfig& filter_config, std::uint64_t seed)
      : duration_s_(experiment.duration_s), config_(config), stream_(config, seed) {
    auto filter = filters::CoilInertialFilter::Make(filter_config);
    Expects(filter.ok(), "a valid configuration");
    filter_ = std::make_unique<filters::CoilInertialFilter>(*filter);
    planner_ = MakePlanner(config, filter_config);
  }

  CoilPulsing Evaluate() {
    const auto ticks = static_cast<std::size_t>(duration_s_ * config_.rate_hz);
    for (std::size_t k = 0; k < ticks; ++k) {
      const double t_s = static_cast<double>(k) / config_.rate_hz;
      const Time now = TimeFromNanoseconds(0) + DurationFromSeconds(t_s);
      if (config_.on_demand && t_s >= config_.pulses.begin_s) {
        if (const auto pulse = planner_->Next(now, *filter_)) {
          stream_.Pulse(pulse->coil, pulse->current_a);
        }
      }
      const simulation::CoilTick tick = stream_.Next();
      filter_->Update(tick.frame);
      if (t_s >= kCoilScoredFrom_s) {
        Add(tick);
      }
    }
    const CoilFigure figure = score_.Figure();
    const double n = std::max(1.0, scored_);
    return {.position_m = figure.position_m,
            .orientation_rad = figure.orientation_rad,
            .duty = on_ / n,
            .tracked = figure.count / n};
  }

 private:
  void Add(const simulation::CoilTick& tick) {
    scored_ += 1.0;
    on_ += tick.frame.drive.coil >= 0 ? 1.0 : 0.0;
    if (filter_->phase() == filters::CoilPhase::kTracking) {
      const filters::CoilInertialState& state = filter_->state();
      score_.Add(state.p_emitter_sensor_m(), state.q_sensor_emitter(), tick);
    }
  }

  double duration_s_;
  simulation::CoilStreamConfig config_;
  simulation::CoilStream stream_;
  std::unique_ptr<filters::CoilInertialFilter> filter_;
  std::optional<filters::CoilPulsePlanner> planner_;
  CoilScore score_;
  double scored_ = 0.0;  // ticks
  double on_ = 0.0;      // of them with a coil on
};

nlohmann::json ToJson(const CoilPulsing& p) {
  return {{"position_m", p.position_m},
          {"orientation_rad", p.orientation_rad},
          {"duty", p.duty},
          {"tracked", p.tracked}};
}

}  // namespace

CoilExperiment MakeRestingExperiment() {
  using simulation::Jet;
  CoilExperiment experiment;
  experiment.name = "rest and reach";
  experiment.duration_s = 90.0;
  experiment.emitter_inertial = false;
  experiment.emitter = [](double) {
    simulation::RigidMotion emitter;
    emitter.p_earth_local_m = {0.0, 0.0, 1.0};
    return emitter;
  };
  // Every 10 s to the other of two places, 25 and 60 cm away, in 1.5 s, with a turn.
  experiment.sensor = [](double t_s) {
    const Jet t = Jet::Variable(t_s);
    Jet far = Jet(0.0);
    for (int step = 0; step < 9; ++step) {
      const double from_s = 3.0 + 10.0 * step;
      const Jet on = simulation::SmoothStep(t, from_s, from_s + 1.5);
      far = step % 2 == 0 ? far + on : far - on;
    }
    const Jet range = 0.25 + 0.35 * far;
    simulation::RigidMotion sensor =
        simulation::MovingPoint({0.8 * range, 0.2 * range, 1.0 + 0.56 * range});
    simulation::RotateAbout(sensor, 2, 1.2 * far);
    simulation::RotateAbout(sensor, 0, 0.7 * far);
    return sensor;
  };
  return experiment;
}

CoilAdaptiveResult EvaluateAdaptive(const CoilExperiment& experiment, CoilNoise noise,
                                    std::uint64_t seed) {
  simulation::CoilStreamConfig stream = MakeCoilStream(experiment, noise, seed);
  const filters::CoilInertialConfig filter = MakeCoilFilter(experiment, noise);
  CoilAdaptiveResult result;
  result.experiment = experiment.name;
  result.noise = noise;
  result.usual = Run(experiment, stream, filter, seed).Evaluate();
  stream.on_demand = true;
  result.planned = Run(experiment, stream, filter, seed).Evaluate();
  stream.on_demand = false;
  stream.pulses.cycle_s =
      std::clamp(3.0 * simulation::PulseLength_s(stream.pulses) / result.planned.duty,
                 stream.pulses.cycle_s, 60.0);
  result.seldom = Run(experiment, stream, filter, seed).Evaluate();
  return result;
}

std::string AdaptiveTable(std::span<const CoilAdaptiveResult> results) {
  std::string text = fmt::format(
      "RMS forward, mm and deg, and time with a coil on\n{:<20} {:>6} | {:^22} | {:^22} | {:^22}\n",
      "experiment", "noise", "usual train", "planned", "train as seldom");
  for (const CoilAdaptiveResult& r : results) {
    text += fmt::format("{:<20.20} {:>3.0f} nT", r.experiment, 1e9 * SigmaOf_tesla(r.noise));
    for (const CoilPulsing* p : {&r.usual, &r.planned, &r.seldom}) {
      text += fmt::format(" | {:>7.1f} {:>6.2f} {:>5.1f} %", kMmPerM * p->position_m,
                          kDegPerRad * p->orientation_rad, 100.0 * p->duty);
    }
    text += '\n';
  }
  return text;
}

nlohmann::json AdaptiveJson(std::span<const CoilAdaptiveResult> results, std::uint64_t seed) {
  nlohmann::json json = {{"seed", seed}, {"trials", nlohmann::json::array()}};
  for (const CoilAdaptiveResult& r : results) {
    json["trials"].push_back({{"experiment", r.experiment},
                              {"sigma_mag_tesla", SigmaOf_tesla(r.noise)},
                              {"usual", ToJson(r.usual)},
                              {"planned", ToJson(r.planned)},
                              {"seldom", ToJson(r.seldom)}});
  }
  return json;
}

}  // namespace limbcast::tool
