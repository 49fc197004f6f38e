#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/limbcast/person/body_trial.hpp"

namespace limbcast::tool {

/// From one time of a recording to another.
struct TimeSpan {
  double from_s = 0.0;
  double to_s = 0.0;
};

/// What the person is known to do when.
struct BodyPhases {
  std::optional<TimeSpan> standing;
  std::optional<TimeSpan> sitting;
  std::vector<TimeSpan> walks;  ///< straight on; two and more: there and back
};

/// One number with the range that it is to be in.
struct BodyFigure {
  std::string name;
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;
  [[nodiscard]] bool holds() const { return value >= low && value <= high; }
};

/// The figures of a believable person (issue 4, acceptance 3 and 4), in degrees: upright while
/// standing, bent while sitting, knees while walking, headings. Only of joints and segments that
/// are known in all of a phase.
///
/// The hip is given twice. `hip` is the ISB's, thigh about pelvis; people who sit tilt the pelvis
/// back by 20 to 30° and so have 50 to 70° there. `thigh about trunk` (T8) is what one sees from
/// outside; it has the range for sitting.
[[nodiscard]] std::vector<BodyFigure> BodyFigures(const BodyTrace& trace, const BodyPhases& phases);

/// A table for people, one figure a line.
[[nodiscard]] std::string FiguresText(const std::vector<BodyFigure>& figures);

/// Peaks of `values` at or above `least`, each the greatest within `apart` samples to both sides.
[[nodiscard]] std::vector<std::size_t> PeaksOf(const std::vector<double>& values, double least,
                                               std::size_t apart);

}  // namespace limbcast::tool
