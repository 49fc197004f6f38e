#pragma once

#include <span>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/sensing/calibrate_sensor.hpp"
#include "common/sensing/session_reference.hpp"

namespace limbcast::tool {

/// One sensor's calibration with the name a person knows it by.
struct NamedReport {
  std::string name;
  sensing::SensorReport report;
};

/// What the terminal shows of one sensor: poses, and for each triad the method, coverage of the
/// sphere, residuals before and after, grade, and what is missing.
[[nodiscard]] std::string CalibrationText(const NamedReport& sensor);

/// A page for people: the tables, a coverage map of both hemispheres, and the readings before and
/// after in three views (inline SVG, no script).
[[nodiscard]] std::string CalibrationHtml(std::span<const NamedReport> sensors,
                                          const sensing::CalibrationSettings& settings);

/// One sensor's reference, or why it has none.
struct NamedReference {
  std::string name;
  sensing::SessionReference reference;  ///< meaningful when `refusal` is empty
  std::string refusal;
};

/// Settings for limbcast-fusion (--config) that say what field this session has: reference of bmf
/// and declination. kInvalidArgument when no sensor with a magnetometer lay still.
[[nodiscard]] Result<std::string> SessionToml(std::span<const NamedReference> sensors,
                                              const sensing::SessionConfig& config);

/// The session's gravity and field, and a line for each sensor: undisturbed, or how it differs.
[[nodiscard]] std::string SessionText(std::span<const NamedReference> sensors,
                                      const sensing::SessionConfig& config);

}  // namespace limbcast::tool
