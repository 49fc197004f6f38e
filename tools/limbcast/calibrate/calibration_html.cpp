#include <fmt/format.h>

#include <cmath>

#include "common/sensing/sphere_coverage.hpp"
#include "tools/limbcast/calibrate/calibration_report.hpp"
#include "tools/limbcast/report/report_text.hpp"

namespace limbcast::tool {
namespace {

using Vectors = std::vector<Eigen::Vector3d>;

constexpr double kDisc = 90.0;  // radius of a hemisphere, SVG units
constexpr double kView = 200.0;

std::string Dot(double x, double y, double radius, const char* colour) {
  return fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='{}' fill='{}'/>", x, y, radius, colour);
}

// Lambert's equal-area projection (Snyder, "Map projections: a working manual", 1987, chapter 24)
// of the hemisphere around +z or −z; x to the right, y up.
std::string OnDisc(const Eigen::Vector3d& unit, bool upper, double radius, const char* colour) {
  if ((unit.z() >= 0.0) != upper) {
    return {};
  }
  const double k = kDisc / std::sqrt(1.0 + std::abs(unit.z()));
  return Dot(100.0 + k * unit.x(), 100.0 - k * unit.y(), radius, colour);
}

std::string CoverageMap(const Vectors& corrected) {
  sensing::SphereCoverage coverage;
  for (const Eigen::Vector3d& y : corrected) {
    coverage.Add(y);
  }
  const auto covered = coverage.covered();
  const auto& probes = sensing::SphereCoverage::Probes();
  std::string html;
  for (const bool upper : {true, false}) {
    html += fmt::format(
        "<svg viewBox='0 -12 200 212'><circle cx='100' cy='100' r='{}' fill='none' "
        "stroke='#999'/><text x='4' y='-2'>{}z side; x right, y up</text>",
        kDisc, upper ? '+' : '-');
    for (std::size_t i = 0; i < probes.size(); ++i) {
      html += OnDisc(probes[i], upper, 6.5, covered[i] ? "#cfe8d5" : "#f3c4b8");
    }
    for (const Eigen::Vector3d& y : corrected) {
      html += OnDisc(y.normalized(), upper, 1.2, "#0b6e99");
    }
    html += "</svg>";
  }
  return html;
}

// Raw and corrected readings from the front, the side and above; the circle is where they belong.
std::string Views(const Vectors& raw, const Vectors& corrected, double norm) {
  constexpr const char* kAxes = "xyz";
  const double scale = 0.32 * kView / norm;
  std::string html;
  for (const auto& [a, b] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 2}}) {
    html += fmt::format("<svg viewBox='0 -12 200 212'><text x='4' y='-2'>{} right, {} up</text>",
                        kAxes[a], kAxes[b]);
    for (const Eigen::Vector3d& r : raw) {
      html += Dot(100.0 + scale * r(a), 100.0 - scale * r(b), 1.0, "#c4572e");
    }
    for (const Eigen::Vector3d& y : corrected) {
      html += Dot(100.0 + scale * y(a), 100.0 - scale * y(b), 1.0, "#0b6e99");
    }
    html += fmt::format("<circle cx='100' cy='100' r='{:.1f}' fill='none' stroke='#333'/></svg>",
                        scale * norm);
  }
  return html;
}

std::string Channel(const char* title, const sensing::ChannelReport& channel, double norm) {
  constexpr std::size_t kMostDots = 800;
  const std::size_t stride = channel.readings.size() / kMostDots + 1;
  Vectors raw;
  Vectors corrected;
  const auto calibration = channel.fit ? channel.fit->calibration : sensing::TriadCalibration{};
  double mean = 0.0;
  for (std::size_t i = 0; i < channel.readings.size(); i += stride) {
    raw.push_back(channel.readings[i]);
    corrected.push_back(calibration.Apply(raw.back()));
    mean += (corrected.back().norm() - mean) / static_cast<double>(raw.size());
  }
  if (raw.empty() || !(mean > 0.0)) {
    return {};
  }
  return fmt::format("<h3>{}</h3><div>", title) + CoverageMap(corrected) +
         Views(raw, corrected, norm > 0.0 ? norm : mean) + "</div>";
}

}  // namespace

std::string CalibrationHtml(std::span<const NamedReport> sensors,
                            const sensing::CalibrationSettings& settings) {
  std::string html =
      "<!doctype html><html lang='en'><head><meta charset='utf-8'><title>Sensor calibration</title>"
      "<style>body{font:14px sans-serif;max-width:1100px;margin:2em auto}svg{width:19%}"
      "text{font-size:10px;fill:#555}pre{overflow-x:auto;font-size:12px}</style></head><body>"
      "<h1>Sensor calibration</h1><p>Discs: the directions seen (<span style='color:#3d8f4f'>green"
      "</span>: within 30° of a reading; <span style='color:#c4572e'>red</span>: missing; dots: "
      "readings). Squares: readings <span style='color:#c4572e'>before</span> and <span "
      "style='color:#0b6e99'>after</span>; they belong on a ball whose outline is the circle.</p>";
  for (const NamedReport& sensor : sensors) {
    html += "<h2>" + EscapedHtml(sensor.name) + "</h2><pre>" +
            EscapedHtml(CalibrationText(sensor)) + "</pre>";
    html += Channel("accelerometer at rest", sensor.report.accel, settings.gravity_m_s2);
    html += Channel("magnetometer", sensor.report.mag, settings.field_tesla);
  }
  return html + "</body></html>\n";
}

}  // namespace limbcast::tool
