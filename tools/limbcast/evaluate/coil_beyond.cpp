#include "tools/limbcast/evaluate/coil_beyond.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "common/base/expects.hpp"
#include "tools/limbcast/evaluate/coil_report.hpp"

namespace limbcast::tool {
namespace {

constexpr double kMmPerM = 1e3;
constexpr double kDegPerRad = 180.0 / std::numbers::pi;
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

CoilLiveFigures Run(const CoilExperiment& experiment, CoilNoise noise, CoilVariant variant,
                    std::uint64_t seed) {
  simulation::CoilStreamConfig stream = MakeCoilStream(experiment, noise, seed);
  filters::CoilInertialConfig filter = MakeCoilFilter(experiment, noise);
  Apply(variant, stream, filter);
  return EvaluateLive(MakeCoilTrial(experiment, noise, stream, filter, seed));
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
    for (const CoilLiveFigures& v : r.variants) {
      text += fmt::format(" | {:>5.1f} / {:>4.1f}  {:>5.2f}", kMmPerM * v.forward.position_m,
                          kMmPerM * v.lagged.position_m, kDegPerRad * v.forward.orientation_rad);
      text += v.tracking.tracked < 1.0 ? '*' : ' ';
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
      trial[kCoilVariantNames[i]] = {{"forward", FigureJson(r.variants[i].forward)},
                                     {"lag_0.6_s", FigureJson(r.variants[i].lagged)},
                                     {"tracked", r.variants[i].tracking.tracked}};
    }
    json["trials"].push_back(std::move(trial));
  }
  return json;
}

}  // namespace limbcast::tool
