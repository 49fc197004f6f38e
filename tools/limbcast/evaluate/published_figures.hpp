#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/result.hpp"
#include "common/filters/filter_factory.hpp"
#include "common/simulation/random.hpp"

namespace limbcast::tool {

/// A filter as the table names it. "ckf-thesis" is the complementary Kalman filter with the
/// covariance blocks and the disturbance drive as printed; "ckf-iron" is the full one told what the
/// thesis took from its sensors and its iron (section 2.3, last paragraph: c_d from moving near
/// iron, noise from lying still): a disturbance lasts 10 s, and the gyro wanders as simulated.
/// "gyro" integrates the gyro from the true start.
struct FigureFilter {
  std::string label;
  std::string name;  ///< of the factory; empty = gyro integration
  std::vector<filters::Setting> settings;
};

/// By label: tqt, ckf, ckf-thesis, ckf-iron, ckf-plain, bmf, gyro, any name of the factory. Fails
/// with kInvalidArgument.
[[nodiscard]] Result<FigureFilter> FindFigureFilter(const std::string& label);

struct PublishedOptions {
  std::uint64_t seed = simulation::kDefaultSeed;
  /// Repetitions of each experiment (published: 10); the ten minutes at rest are repeated a third
  /// as often. Range: [1, 100].
  int trials = 10;
  std::vector<FigureFilter> filters;
  /// Only experiments of this name; empty = all.
  std::string only;
};

/// Over the repetitions.
struct Spread {
  double mean_deg = 0.0;
  double std_deg = 0.0;
  double max_deg = 0.0;
};

/// One figure of the thesis, and what the simulation makes of it.
struct PublishedRow {
  std::string experiment;   ///< "static"
  std::string what;         ///< "10 min, iron at 5 cm: rms"
  std::string compensated;  ///< as printed, for the filter with magnetic compensation; "" = none
  std::string plain;        ///< the same without compensation, or for gyro integration
  bool worst = false;       ///< the figure is the largest of all repetitions, not their mean
  std::map<std::string, Spread> simulated;  ///< by label of the filter
};

/// Runs the experiments. `progress` is told (done, all, name) before each repetition; may be empty.
[[nodiscard]] std::vector<PublishedRow> ComputePublishedRows(
    const PublishedOptions& options,
    const std::function<void(std::size_t, std::size_t, const std::string&)>& progress = {});

/// Table 1 of the theory report of McGhee et al.: RMS quaternion error after 1, 2 and 3 full
/// Gauss–Newton steps from starts up to 0.1 wrong in each component.
struct TableOneRow {
  double max_noise = 0.0;
  double published[3] = {};
  double simulated[3] = {};
};
/// With `trials` random orientations for each cell, dip 60°.
[[nodiscard]] std::vector<TableOneRow> ComputeTableOne(std::uint64_t seed, int trials = 4000);

[[nodiscard]] std::string PublishedTable(const PublishedOptions& options,
                                         const std::vector<PublishedRow>& rows,
                                         const std::vector<TableOneRow>& table_one);
[[nodiscard]] nlohmann::json PublishedJson(const PublishedOptions& options,
                                           const std::vector<PublishedRow>& rows,
                                           const std::vector<TableOneRow>& table_one);

}  // namespace limbcast::tool
