#pragma once

#include <string>
#include <vector>

#include "tools/limbcast/person/body_figures.hpp"
#include "tools/limbcast/person/body_trial.hpp"

namespace limbcast::tool {

/// A page for people: what was calibrated, the figures, and hip, knee and ankle of both sides over
/// time as SVG. Needs nothing from outside.
[[nodiscard]] std::string BodyHtml(const std::string& title, const BodyTrace& trace,
                                   const std::vector<BodyFigure>& figures);

}  // namespace limbcast::tool
