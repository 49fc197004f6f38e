#include "tools/limbcast/evaluate/gap_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace limbcast::tool {
namespace {

constexpr double kMmPerM = 1e3;
constexpr const char* kPlacement =
    "gap k begins 5 s + k (gap + 3 s) after the first row in motion; it counts when it lies in "
    "motion and the marker is known before, after and in 90 % of it; all gaps of a length in one "
    "run";

// Issue 5: means over the twelve BROAD trials of a plain implementation of the specification, mm,
// in the order of GapFill; 0 = not stated.
struct Plain {
  double gap_s;
  std::array<double, kGapFillCount> mm;
};
constexpr std::array kPlain = {Plain{0.1, {0, 0, 0.65, 0}}, Plain{0.5, {10, 3.2, 1.8, 35}},
                               Plain{1.0, {0, 0, 3.4, 0}}, Plain{2.0, {85, 0, 8.6, 323}}};

// Design/position.md section 14 (thesis, other recordings), mm.
struct Published {
  double gap_s;
  int ratio;
  const char* text;
};
constexpr std::array kPublished = {
    Published{2.0, 0, "published, 2 s, max z: forward 11.6, smoothed 3.8, spline 121"},
    Published{0.0, 1, "published, ratio 1: difference < 0.1"},
    Published{0.0, 10, "published, ratio <= 10: max < 1"},
    Published{0.0, 100, "published, ratio 100, RMS: forward 15, smoothed 2.5"}};

using Key = std::pair<double, int>;

std::vector<Key> KeysOf(std::span<const GapResult> results) {
  std::vector<Key> keys;
  for (const GapResult& result : results) {
    const Key key{result.gap_s, result.ratio};
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
      keys.push_back(key);
    }
  }
  return keys;
}

std::string GapRow(const GapResult& r) {
  std::string row = fmt::format("{:<46.46} {:>5}", r.trial, r.gaps);
  for (const FillFigure& f : r.fills) {
    row += fmt::format(" {:>9.2f} {:>7.1f}", kMmPerM * f.mean_max_m, kMmPerM * f.worst_max_m);
  }
  row += " |";
  for (const FillFigure& f : r.fills) {
    row += fmt::format(" {:>7.2f}", kMmPerM * f.mean_max_z_m);
  }
  return row + fmt::format(" | {:>5.1f} {:>5.1f} {:>5.1f}\n", r.fills[0].mean_nees,
                           r.fills[1].mean_nees, r.fills[2].mean_nees);
}

std::string PlainRow(const char* name, const Plain& plain, double factor) {
  std::string row = fmt::format("{:<46.46} {:>5}", name, "");
  for (const double mm : plain.mm) {
    row += mm > 0.0 ? fmt::format(" {:>9.2f} {:>7}", factor * mm, "")
                    : fmt::format(" {:>9} {:>7}", "-", "");
  }
  return row + "\n";
}

std::string RatioRow(const GapResult& r) {
  std::string row = fmt::format("{:<46.46} {:>5}", r.trial, "");
  for (std::size_t i = 0; i + 1 < kGapFillCount; ++i) {
    row +=
        fmt::format(" {:>9.3f} {:>7.2f}", kMmPerM * r.fills[i].rms_m, kMmPerM * r.fills[i].max_m);
  }
  return row + "\n";
}

nlohmann::json ResultJson(const GapResult& r) {
  nlohmann::json json = {{"trial", r.trial}};
  if (r.ratio > 0) {
    json["ratio"] = r.ratio;
  } else {
    json["gap_s"] = r.gap_s;
    json["gaps"] = r.gaps;
  }
  for (std::size_t i = 0; i < kGapFillCount; ++i) {
    const FillFigure& f = r.fills[i];
    if (r.ratio > 0 && i == static_cast<std::size_t>(GapFill::kSpline)) {
      continue;
    }
    json[kGapFillNames[i]] = r.ratio > 0 ? nlohmann::json{{"rms_m", f.rms_m}, {"max_m", f.max_m}}
                                         : nlohmann::json{{"mean_max_m", f.mean_max_m},
                                                          {"worst_max_m", f.worst_max_m},
                                                          {"mean_max_z_m", f.mean_max_z_m},
                                                          {"mean_nees", f.mean_nees}};
  }
  return json;
}

}  // namespace

GapResult MeanOfGaps(std::span<const GapResult> results, double gap_s, int ratio) {
  GapResult mean;
  mean.gap_s = gap_s;
  mean.ratio = ratio;
  double n = 0.0;
  for (const GapResult& r : results) {
    if (r.gap_s != gap_s || r.ratio != ratio || (ratio == 0 && r.gaps == 0)) {
      continue;
    }
    n += 1.0;
    mean.gaps += r.gaps;
    for (std::size_t i = 0; i < kGapFillCount; ++i) {
      FillFigure& m = mean.fills[i];
      const FillFigure& f = r.fills[i];
      m.mean_max_m += f.mean_max_m;
      m.mean_max_z_m += f.mean_max_z_m;
      m.rms_m += f.rms_m;
      m.mean_nees += f.mean_nees;
      m.worst_max_m = std::max(m.worst_max_m, f.worst_max_m);
      m.max_m = std::max(m.max_m, f.max_m);
    }
  }
  mean.trial = fmt::format("mean of {} trials", n);
  for (FillFigure& m : mean.fills) {
    const double weight = n > 0.0 ? 1.0 / n : 0.0;
    m.mean_max_m *= weight;
    m.mean_max_z_m *= weight;
    m.rms_m *= weight;
    m.mean_nees *= weight;
  }
  return mean;
}

std::string GapTable(std::span<const GapResult> results, std::span<const std::string> settings) {
  std::string text;
  for (const std::string& setting : settings) {
    text += fmt::format("changed: {}\n", setting);
  }
  for (const auto& [gap_s, ratio] : KeysOf(results)) {
    if (ratio == 0) {
      text += fmt::format(
          "\ngaps of {} s: largest 3-D error in a gap, mean and worst of all gaps, mm | the mean "
          "of "
          "the largest vertical error | NEES of 3\n{:<46} {:>5} {:>17} {:>17} {:>17} {:>17} | "
          "{:>7} {:>7} {:>7} {:>7} | {:>5} {:>5} {:>5}\n",
          gap_s, "trial", "gaps", "forward", "fixed lag", "smoothed", "spline", "fwd z", "lag z",
          "smth z", "spl z", "fwd", "lag", "smth");
    } else {
      text += fmt::format(
          "\none marker in {} samples: 3-D error, RMS and largest, mm\n{:<46} {:>5} {:>17} {:>17} "
          "{:>17}\n",
          ratio, "trial", "", "forward", "fixed lag", "smoothed");
    }
    for (const GapResult& r : results) {
      if (r.gap_s == gap_s && r.ratio == ratio) {
        text += ratio == 0 ? GapRow(r) : RatioRow(r);
      }
    }
    const GapResult mean = MeanOfGaps(results, gap_s, ratio);
    text += ratio == 0 ? GapRow(mean) : RatioRow(mean);
    for (const Plain& plain : kPlain) {
      if (ratio == 0 && plain.gap_s == gap_s) {
        text += PlainRow("plain implementation (issue 5)", plain, 1.0);
        text += PlainRow("goal", plain, 0.5);
      }
    }
    for (const Published& published : kPublished) {
      if (published.gap_s == gap_s && published.ratio == ratio) {
        text += fmt::format("{}\n", published.text);
      }
    }
  }
  return text;
}

nlohmann::json GapJson(std::span<const GapResult> results, std::span<const std::string> settings) {
  nlohmann::json json = {{"settings", settings},
                         {"placement", kPlacement},
                         {"trials", nlohmann::json::array()},
                         {"means", nlohmann::json::array()}};
  for (const GapResult& r : results) {
    json["trials"].push_back(ResultJson(r));
  }
  for (const auto& [gap_s, ratio] : KeysOf(results)) {
    nlohmann::json mean = ResultJson(MeanOfGaps(results, gap_s, ratio));
    for (const Plain& plain : kPlain) {
      if (ratio == 0 && plain.gap_s == gap_s) {
        for (std::size_t i = 0; i < kGapFillCount; ++i) {
          if (plain.mm[i] > 0.0) {
            mean["plain_implementation_m"][kGapFillNames[i]] = plain.mm[i] / kMmPerM;
          }
        }
      }
    }
    for (const Published& published : kPublished) {
      if (published.gap_s == gap_s && published.ratio == ratio) {
        mean["published"] = published.text;
      }
    }
    json["means"].push_back(mean);
  }
  return json;
}

}  // namespace limbcast::tool
