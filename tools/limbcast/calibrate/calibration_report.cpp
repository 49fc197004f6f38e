#include "tools/limbcast/calibrate/calibration_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "common/units/units.hpp"

namespace limbcast::tool {
namespace {

constexpr double kMicro = 1e6;

std::string Residual(const sensing::TriadFit& fit, bool is_gyro) {
  if (fit.method == "null-at-rest" || fit.method == "known-rotation") {
    return "-";
  }
  return is_gyro ? fmt::format("{:.2f} -> {:.2f} deg", units::DegFromRad(fit.residual_before),
                               units::DegFromRad(fit.residual_after))
                 : fmt::format("{:.2f} -> {:.2f} %", 100.0 * fit.residual_before,
                               100.0 * fit.residual_after);
}

std::string Row(const char* name, const sensing::ChannelReport& channel) {
  std::string row;
  if (channel.fit) {
    const sensing::TriadFit& fit = *channel.fit;
    row = fmt::format("  {:<6} {:<18} {:>6} {:>8.0f} % {:>21} {:>10} {:>8}\n", name, fit.method,
                      fit.points, 100.0 * fit.coverage, Residual(fit, *name == 'g'),
                      fit.sigma_scale >= 1.0 ? std::string("-")
                                             : fmt::format("{:.3f} %", 100.0 * fit.sigma_scale),
                      sensing::ToText(sensing::GradeOf(fit)));
  } else {
    row = fmt::format("  {:<6} refused\n", name);
  }
  return channel.refusal.empty() ? row : row + fmt::format("         {}\n", channel.refusal);
}

std::vector<sensing::SessionReference> KnownReferences(std::span<const NamedReference> sensors) {
  std::vector<sensing::SessionReference> known;
  for (const NamedReference& sensor : sensors) {
    if (sensor.refusal.empty()) {
      known.push_back(sensor.reference);
    }
  }
  return known;
}

}  // namespace

std::string CalibrationText(const NamedReport& sensor) {
  const sensing::SensorReport& report = sensor.report;
  std::string text = fmt::format("{}: {} poses at rest, {:.1f} s in all", sensor.name, report.poses,
                                 report.rest_s);
  if (std::isfinite(report.calibration.temperature_celsius)) {
    text += fmt::format(", {:.1f} °C", report.calibration.temperature_celsius);
  }
  if (report.dip_rad) {
    text += fmt::format(", field dips {:.1f}°", units::DegFromRad(*report.dip_rad));
  }
  text += fmt::format("\n  {:<6} {:<18} {:>6} {:>10} {:>21} {:>10} {:>8}\n", "", "method", "points",
                      "coverage", "before -> after", "sigma", "grade");
  return text + Row("accel", report.accel) + Row("mag", report.mag) + Row("gyro", report.gyro);
}

Result<std::string> SessionToml(std::span<const NamedReference> sensors,
                                const sensing::SessionConfig& config) {
  const sensing::SessionReference common =
      sensing::CommonReference(KnownReferences(sensors), config);
  if (!(common.field_tesla > 0.0)) {
    return Error{ErrorCode::kInvalidArgument,
                 "no sensor with a magnetometer lay still: there is no field to write"};
  }
  return fmt::format(
      "# Measured by limbcast calibrate session, for limbcast-fusion --config THIS_FILE\n"
      "[fusion]\n"
      "declination_deg = {:.3f}\n"
      "\n"
      "[filter.settings.bmf]\n"
      "reference_field_tesla = {:.4e}\n"
      "reference_dip_rad = {:.5f}\n",
      units::DegFromRad(common.declination_rad), common.field_tesla, common.dip_rad);
}

std::string SessionText(std::span<const NamedReference> sensors,
                        const sensing::SessionConfig& config) {
  const std::vector<sensing::SessionReference> known = KnownReferences(sensors);
  const sensing::SessionReference common = sensing::CommonReference(known, config);
  std::string text = fmt::format("gravity {:.3f} m/s²", common.gravity_m_s2);
  text += common.field_tesla > 0.0
              ? fmt::format(", field {:.1f} µT, dip {:.1f}°", kMicro * common.field_tesla,
                            units::DegFromRad(common.dip_rad))
              : std::string(", no magnetometer");
  text += fmt::format(", declination {:.1f}°\n", units::DegFromRad(common.declination_rad));
  const auto verdicts = sensing::JudgeField(known, config);
  std::size_t next = 0;
  for (const NamedReference& sensor : sensors) {
    std::string verdict = sensor.refusal;
    if (sensor.refusal.empty()) {
      verdict = verdicts[next].disturbed             ? "DISTURBED: " + verdicts[next].reason
                : sensor.reference.field_tesla > 0.0 ? "undisturbed"
                                                     : "no magnetometer";
      ++next;
    }
    text += fmt::format("  {:<24} {}\n", sensor.name, verdict);
  }
  return text;
}

}  // namespace limbcast::tool
