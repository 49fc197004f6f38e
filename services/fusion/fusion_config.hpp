#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.hpp"
#include "common/base/time.hpp"
#include "common/body/segment.hpp"
#include "common/config/config_file.hpp"
#include "common/filters/filter.hpp"
#include "common/filters/filter_factory.hpp"
#include "services/fusion/position_config.hpp"

namespace limbcast::fusion {

/// Which filters run on a segment.
struct FilterChoice {
  std::string name = "bmf";  ///< published as slot 0
  std::string beside;        ///< run on the same samples and published as slot 1; "" = none
  bool operator==(const FilterChoice&) const = default;
};

/// Settings of the fusion service: tables [fusion] and [filter] of its file.
struct FusionConfig {
  /// Threads that run filters. A body always stays on one of them. Range: [1, 64].
  std::size_t workers = 2;

  /// Samples that may wait for one worker; more are refused as "overload". Range: [64, 1048576].
  std::size_t queue_capacity = 8192;

  /// A sample that claims to be measured this long after it came is refused. Generous, because a
  /// recording played faster than real time runs ahead of the clock. Range: [0.001, 1e9].
  double max_future_s = 86400.0;

  /// Magnetic north's bearing from true north, clockwise (east) positive: what is published then
  /// has y to true north where a magnetometer gives heading. Range: [-180, 180].
  double declination_deg = 0.0;

  /// Publishes the states of a body together, as `segment_frame`: cheaper for many people. Else
  /// each alone, as `segment_state`. Services that stand by for each other publish the same way.
  bool segment_frame = false;

  /// Folder in which the states of the filters survive a restart; "" = they do not. One service
  /// each.
  std::string state_dir;

  /// How often they are saved. Range: [0.1, 3600].
  double state_period_s = 2.0;

  /// Older ones are not taken up again. Range: [0, 1e7].
  double state_max_age_s = 3600.0;

  /// Tables [fusion.coils] and [fusion.markers].
  PositionConfig position;

  FilterChoice filter;
  std::map<body::Segment, FilterChoice> segment_filters;  ///< segments that differ
  std::map<std::string, std::vector<filters::Setting>, std::less<>> filter_settings;  ///< by filter
};

/// Makes the filter of a name; fails with kInvalidArgument. Called from several threads.
using FilterFactory =
    std::function<Result<std::unique_ptr<filters::OrientationFilter>>(std::string_view name)>;

/// Reads [fusion], [filter], [filter.segment.<segment>] and [filter.settings.<name>]. Refusals are
/// remembered in `file` (ask Finish).
[[nodiscard]] FusionConfig ReadFusionConfig(const config::ConfigFile& file);

/// A number that differs when the settings of the filters do.
[[nodiscard]] std::uint64_t FilterSettingsNumber(const FusionConfig& config);

/// filters::MakeFilter with the settings of `config`.
[[nodiscard]] FilterFactory MakeFilterFactory(const FusionConfig& config);

/// Ranges, and that `factory` makes every filter that is chosen.
[[nodiscard]] Status Validate(const FusionConfig& config, const FilterFactory& factory);

}  // namespace limbcast::fusion
