#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/filters/position/optical_inertial_config.hpp"
#include "common/sensing/marg_sample.hpp"
#include "common/sensing/position_samples.hpp"
#include "services/gateway/drivers/replay/recording.hpp"

namespace limbcast::tool {

/// One inertial unit of a recording with its true position, row by row; the truth plays the marker.
struct GapTrial {
  std::string name;
  double rate_hz = 0.0;
  std::vector<sensing::MargSample> samples;
  std::vector<sensing::MarkerPosition> markers;  ///< not visible where the truth is not known
  std::vector<std::uint8_t> movement;            ///< 1 in motion phases
};

/// The first sensor of `recording` that has a truth with positions; nothing when there is none.
[[nodiscard]] std::optional<GapTrial> GapTrialOf(const gateway::Recording& recording,
                                                 const std::string& name);

/// Rows [begin, end) in which the marker is hidden.
struct Gap {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Where gaps of one length lie. The same for everybody: gap k begins 5 s + k (gap + 3 s) after the
/// first row in motion, rounded to rows; it counts when all its rows and the ones before and after
/// are in motion, the marker is known in these two, and in at least 90 % of its rows.
[[nodiscard]] std::vector<Gap> PlaceGaps(const GapTrial& trial, double gap_s);

/// Ways to fill a gap.
enum class GapFill : std::uint8_t { kForward = 0, kFixedLag = 1, kSmoothed = 2, kSpline = 3 };
inline constexpr std::size_t kGapFillCount = 4;
inline constexpr std::array<const char*, kGapFillCount> kGapFillNames = {"forward", "fixed_lag",
                                                                         "smoothed", "spline"};

/// Figures of one way.
struct FillFigure {
  double mean_max_m = 0.0;    ///< mean over gaps of the largest 3-D error in the gap
  double worst_max_m = 0.0;   ///< largest 3-D error in any gap
  double mean_max_z_m = 0.0;  ///< mean over gaps of the largest vertical error, as published
  double rms_m = 0.0;         ///< of all rows (ratios), 3-D
  double max_m = 0.0;         ///< of all rows (ratios), 3-D
  double mean_nees = 0.0;     ///< eᵀP⁻¹e in the gaps; 3 = the reported 1-sigma is right
};

/// A trial with gaps of one length, or with one marker in `ratio` rows.
struct GapResult {
  std::string trial;
  double gap_s = 0.0;  ///< 0: a ratio
  int ratio = 0;       ///< 0: gaps
  std::size_t gaps = 0;
  std::array<FillFigure, kGapFillCount> fills;
};

/// Fills all gaps of one length in one run over the trial. Forward and fixed lag are the live
/// filter, from the first row; smoothed is what `limbcast smooth` does. Errors are taken at the
/// filter's epochs, of the marker, where the truth is known. The spline is a cubic Hermite curve
/// between ends fitted over 0.15 s.
[[nodiscard]] GapResult EvaluateGaps(const filters::OpticalInertialConfig& config,
                                     const GapTrial& trial, double gap_s);

/// Shows the filter every ratio-th row only, from 5 s after the first row in motion on, and
/// compares in all motion after that. No spline.
[[nodiscard]] GapResult EvaluateRatio(const filters::OpticalInertialConfig& config,
                                      const GapTrial& trial, int ratio);

}  // namespace limbcast::tool
