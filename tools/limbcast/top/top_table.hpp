#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "common/base/time.hpp"
#include "tools/limbcast/monitor/pipeline_model.hpp"

namespace limbcast::tool {

/// What rates are computed from: the counters of a model at one instant.
struct TopCounts {
  Time at{};
  std::map<std::pair<BodyId, body::Segment>, std::uint64_t> states;
  std::map<BodyId, std::uint64_t> skeletons;
};
[[nodiscard]] TopCounts CountsOf(const PipelineModel& model, Time now);

/// Processes, bodies and segments with rates (since `before`), ages and states, as JSON.
[[nodiscard]] nlohmann::json TopJson(const PipelineModel& model, const TopCounts& before, Time now);

/// The same as a table of text.
[[nodiscard]] std::string TopText(const nlohmann::json& top);

}  // namespace limbcast::tool
