#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/limbcast/doctor/doctor_facts.hpp"

namespace limbcast::tool {

/// One thing that is wrong, and what to do about it.
struct Finding {
  std::string id;      ///< "no_peers", "clock_offset", ...: for scripts
  std::string text;    ///< what is wrong, with names and numbers
  std::string advice;  ///< what to do
};

/// Pure. The most likely cause first; empty when nothing is wrong.
[[nodiscard]] std::vector<Finding> Diagnose(const DoctorFacts& facts);

/// "no_peers: ... -> ...", one line.
[[nodiscard]] std::string ToText(const Finding& finding);
/// {"network": ..., "findings": [{"id", "text", "advice"}, ...], "processes": n, "peers": n}
[[nodiscard]] nlohmann::json ToJson(const DoctorFacts& facts, const std::vector<Finding>& findings);

}  // namespace limbcast::tool
