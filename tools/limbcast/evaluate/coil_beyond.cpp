#include "tools/limbcast/evaluate/coil_beyond.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>

#include "common/base/expects.hpp"
#include "common/filters/position/coil_inertial_filter.hpp"
#include "common/filters/position/coil_smoothing.hpp"

namespace limbcast::tool {
namespace {

constexpr double kMmPerM = 1e3;
constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr double kLag_s = 0.6;
constexpr double kFastRate_hz = 400.0;
constexpr double kApart_m = 0.12;

void Apply(CoilVariant variant, simulation::CoilStreamConfig& stream,
           filters::CoilInertialConfig& filter) {
  if (variant == CoilVariant::kPulsesFast || variant == CoilVariant::kTonesFast) {
    stream.rate_hz = kFastRate_hz;
  }
  if (variant == CoilVariant::kTones || variant == CoilVariant::kTonesFast) {
    stream.tones = sensing::CoilTones{};
    filter.tone_window_s = stream.tones->window_s;
    Expects(Validate(*stream.tones, stream.rate_hz).ok(), "tones that the magnetometer can tell");
  }
  if (variant == CoilVariant::kApart) {
    stream.source.centre_m.col(0) = kApart_m * Eigen::Vector3d::UnitY();
    stream.source.centre_m.col(1) = -kApart_m * Eigen::Vector3d::UnitY();
    filter.half_space.reset();
  }
  filter.source = stream.source;
}

CoilVariantFigures Run(const CoilExperiment& experiment, CoilNoise noise, CoilVariant variant,
                       std::uint64_t seed) {
  simulation::CoilStreamConfig config = MakeCoilStream(experiment, noise, seed);
  filters::CoilInertialConfig filter_config = MakeCoilFilter(experiment, noise);
  Apply(variant, config, filter_config);
  const auto ticks = simulation::SimulateCoil(config, experiment.duration_s, seed);
  auto filter = filters::CoilInertialFilter::Make(filter_config);
  Expects(filter.ok(), "a valid configuration");
  filters::CoilFixedLag fixed_lag(kLag_s, config.rate_hz);
  CoilScore forward;
  CoilScore lagged_score;
  double scored = 0.0;
  double tracked = 0.0;
  const auto first = static_cast<std::size_t>(kCoilScoredFrom_s * config.rate_hz);
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    const Time now = ticks[k].frame.measured_at;
    filter->Update(ticks[k].frame);
    filters::CoilEstimate lagged;
    if (fixed_lag.Update(*filter, now, lagged) && lagged.valid) {
      const auto then = static_cast<std::size_t>(
          std::lround(ToSeconds(lagged.measured_at.time_since_epoch()) * config.rate_hz));
      if (then >= first) {
        lagged_score.Add(lagged.p_emitter_sensor_m, lagged.q_sensor_emitter, ticks[then]);
      }
    }
    if (k < first) {
      continue;
    }
    scored += 1.0;
    if (filter->phase() == filters::CoilPhase::kTracking) {
      tracked += 1.0;
      forward.Add(filter->state().p_emitter_sensor_m(), filter->state().q_sensor_emitter(),
                  ticks[k]);
    }
  }
  return {forward.Figure(), lagged_score.Figure(), tracked / std::max(1.0, scored)};
}

nlohmann::json ToJson(const CoilFigure& f) {
  return {{"position_m", f.position_m},
          {"distance_m", f.distance_m},
          {"orientation_rad", f.orientation_rad}};
}

}  // namespace

CoilBeyondResult EvaluateBeyond(const CoilExperiment& experiment, CoilNoise noise,
                                std::uint64_t seed) {
  CoilBeyondResult result;
  result.experiment = experiment.name;
  result.noise = noise;
  for (std::size_t i = 0; i < kCoilVariantCount; ++i) {
    result.variants[i] = Run(experiment, noise, static_cast<CoilVariant>(i), seed);
  }
  return result;
}

std::string BeyondTable(std::span<const CoilBeyondResult> results) {
  std::string text = "RMS 3-D position forward / lag 0.6 s in mm, orientation forward in deg\n";
  text += fmt::format("{:<20} {:>6}", "experiment", "noise");
  for (const char* name : kCoilVariantNames) {
    text += fmt::format(" | {:^19}", name);
  }
  text += '\n';
  for (const CoilBeyondResult& r : results) {
    text += fmt::format("{:<20.20} {:>3.0f} nT", r.experiment, 1e9 * SigmaOf_tesla(r.noise));
    for (const CoilVariantFigures& v : r.variants) {
      text += fmt::format(" | {:>5.1f} / {:>4.1f}  {:>5.2f}", kMmPerM * v.forward.position_m,
                          kMmPerM * v.lagged.position_m, kDegPerRad * v.forward.orientation_rad);
      text += v.tracked < 1.0 ? '*' : ' ';
    }
    text += '\n';
  }
  return text + "* not tracked all the time\n";
}

nlohmann::json BeyondJson(std::span<const CoilBeyondResult> results, std::uint64_t seed) {
  nlohmann::json json = {{"seed", seed}, {"trials", nlohmann::json::array()}};
  for (const CoilBeyondResult& r : results) {
    nlohmann::json trial = {{"experiment", r.experiment},
                            {"sigma_mag_tesla", SigmaOf_tesla(r.noise)}};
    for (std::size_t i = 0; i < kCoilVariantCount; ++i) {
      trial[kCoilVariantNames[i]] = {{"forward", ToJson(r.variants[i].forward)},
                                     {"lag_0.6_s", ToJson(r.variants[i].lagged)},
                                     {"tracked", r.variants[i].tracked}};
    }
    json["trials"].push_back(std::move(trial));
  }
  return json;
}

}  // namespace limbcast::tool
