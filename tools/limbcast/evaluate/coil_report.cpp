#include "tools/limbcast/evaluate/coil_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

namespace limbcast::tool {
namespace {

constexpr double kMmPerM = 1e3;
constexpr double kDegPerRad = 180.0 / std::numbers::pi;

const CoilExperiment* ExperimentOf(std::span<const CoilExperiment> experiments,
                                   const std::string& name) {
  const auto found = std::find_if(experiments.begin(), experiments.end(),
                                  [&](const CoilExperiment& e) { return e.name == name; });
  return found == experiments.end() ? nullptr : &*found;
}

const char* TextOf(CoilNoise noise) {
  return noise == CoilNoise::kThesis ? "50 nT, unipolar pulses of 60 ms, 3 in 600 ms"
                                     : "15 nT, bipolar pulses of 17 + 17 ms, 3 in 600 ms";
}

std::string SpreadOf(const CoilResult& r) {
  const auto mm = [&](CoilMethod method) {
    return kMmPerM * r.deviations[static_cast<std::size_t>(method)].position_m;
  };
  return r.repetitions < 2 ? fmt::format("{:>3} {:^11}", r.repetitions, "-")
                           : fmt::format("{:>3} {:>5.1f} {:>5.1f}", r.repetitions,
                                         mm(CoilMethod::kForward), mm(CoilMethod::kSmoothed));
}

nlohmann::json TrackingJson(const CoilTracking& t) {
  return {{"tracked", t.tracked}, {"losses", t.losses}, {"nees_per_axis", t.nees}};
}

}  // namespace

nlohmann::json FigureJson(const CoilFigure& figure) {
  return {{"position_m", figure.position_m},
          {"distance_m", figure.distance_m},
          {"orientation_rad", figure.orientation_rad}};
}

std::string CoilTable(std::span<const CoilExperiment> experiments,
                      std::span<const CoilResult> results) {
  std::string text;
  for (const CoilNoise noise : {CoilNoise::kThesis, CoilNoise::kModern}) {
    text += fmt::format(
        "\n{}; RMS: position in 3-D and distance, mm; orientation, deg\n{:<20} {:>5} | {:^20} | "
        "{:^20} | {:^20} | {:^20} | {:^20} | {:^11} {:^10} | {:>5} {:>6} {:>5} | {:^18} | {:^15}\n",
        TextOf(noise), "experiment", "range", "magnetic only", "loose", "forward", "lag 0.6 s",
        "smoothed", "publ. magn.", "publ. fused", "valid", "losses", "NEES", "the same, loose",
        "n, SD fwd, sm.");
    for (const CoilResult& r : results) {
      const CoilExperiment* e = ExperimentOf(experiments, r.experiment);
      if (r.noise != noise) {
        continue;
      }
      text += fmt::format("{:<20.20} {:>5.2f}", r.experiment, r.mean_range_m);
      for (const CoilFigure& f : r.figures) {
        text += fmt::format(" | {:>7.1f} {:>6.1f} {:>5.2f}", kMmPerM * f.position_m,
                            kMmPerM * f.distance_m, kDegPerRad * f.orientation_rad);
      }
      text += e == nullptr ? fmt::format(" | {:^11} {:^10}", "-", "-")
                           : fmt::format(" | {:>5.1f} {:>5.1f} {:>5.1f} {:>4.1f}",
                                         e->published_magnetic_mm, e->published_magnetic_deg,
                                         e->published_fused_mm, e->published_fused_deg);
      for (const CoilTracking& t : {r.forward, r.loose}) {
        text += fmt::format(" | {:>4.0f}% {:>6} {:>5.1f}", 100.0 * t.tracked, t.losses, t.nees);
      }
      text += fmt::format(" | {}\n", SpreadOf(r));
    }
  }
  return text;
}

std::string EnduranceText(const std::string& what, const CoilEndurance& e) {
  return fmt::format(
      "{}: {:.2f} h in {} runs, forward {:.1f} mm RMS; diverged {}, frames on the wrong side {}, "
      "losses declared {}\n"
      "  track taken away {} times, back after {:.2f} s at most, later than 2 s {}; moved to the "
      "mirror image {} times, later than 2 s {}\n",
      what, e.hours, e.runs, kMmPerM * e.rms_m, e.diverged, e.flips, e.losses, e.injected,
      e.slowest_s, e.late, e.mirrored, e.mirrored_late);
}

nlohmann::json EnduranceJson(const CoilEndurance& e) {
  return {{"hours", e.hours},         {"runs", e.runs},         {"diverged", e.diverged},
          {"flips", e.flips},         {"losses", e.losses},     {"injected", e.injected},
          {"late", e.late},           {"mirrored", e.mirrored}, {"mirrored_late", e.mirrored_late},
          {"slowest_s", e.slowest_s}, {"rms_m", e.rms_m}};
}

nlohmann::json CoilJson(std::span<const CoilExperiment> experiments,
                        std::span<const CoilResult> results, std::uint64_t seed) {
  nlohmann::json json = {{"seed", seed}, {"trials", nlohmann::json::array()}};
  for (const CoilResult& r : results) {
    nlohmann::json trial = TrackingJson(r.forward);
    trial["experiment"] = r.experiment;
    trial["noise"] = TextOf(r.noise);
    trial["mean_range_m"] = r.mean_range_m;
    trial["repetitions"] = r.repetitions;
    for (std::size_t i = 0; i < kCoilMethodCount; ++i) {
      trial[kCoilMethodNames[i]] = FigureJson(r.figures[i]);
      if (r.repetitions > 1) {
        trial[kCoilMethodNames[i]]["standard_deviation"] = FigureJson(r.deviations[i]);
      }
    }
    trial[kCoilMethodNames[static_cast<std::size_t>(CoilMethod::kLoose)]].update(
        TrackingJson(r.loose));
    if (const CoilExperiment* e = ExperimentOf(experiments, r.experiment)) {
      trial["published"] = {{"magnetic_only_m", e->published_magnetic_mm / kMmPerM},
                            {"magnetic_only_rad", e->published_magnetic_deg / kDegPerRad},
                            {"fused_m", e->published_fused_mm / kMmPerM},
                            {"fused_rad", e->published_fused_deg / kDegPerRad}};
    }
    json["trials"].push_back(trial);
  }
  return json;
}

}  // namespace limbcast::tool
