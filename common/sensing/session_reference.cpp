#include "common/sensing/session_reference.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "common/sensing/axis_words.hpp"

namespace limbcast::sensing {
namespace {

constexpr double kDegPerRad = 57.29577951308232;  // for messages only
constexpr double kMicroTesla = 1e6;

double MedianOf(std::span<const SessionReference> sensors,
                const std::function<double(const SessionReference&)>& value) {
  std::vector<double> values;
  for (const SessionReference& sensor : sensors) {
    values.push_back(value(sensor));
  }
  if (values.empty()) {
    return 0.0;
  }
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2.0;
}

}  // namespace

Result<SessionReference> MeasureSessionReference(std::span<const MargSample> samples,
                                                 const SessionConfig& config) {
  std::size_t end = 0;
  while (end < samples.size() && samples[end].measured_at - samples[0].measured_at <=
                                     DurationFromSeconds(config.window_s)) {
    ++end;
  }
  const std::vector<RestPose> poses = FindRestPoses(samples.first(end), config.rest);
  const auto longest = std::max_element(
      poses.begin(), poses.end(),
      [](const RestPose& a, const RestPose& b) { return a.end - a.begin < b.end - b.begin; });
  if (longest == poses.end()) {
    return Error{ErrorCode::kInvalidArgument, "the sensor was never still in the first " +
                                                  NumberText(config.window_s, 1) +
                                                  " s: stand still at the begin"};
  }
  SessionReference reference;
  reference.gravity_m_s2 = longest->accel_m_s2.norm();
  reference.declination_rad = config.declination_rad;
  reference.rest_s =
      ToSeconds(samples[longest->end - 1].measured_at - samples[longest->begin].measured_at);
  if (longest->mag_count > 0) {
    reference.field_tesla = longest->mag_tesla.norm();
    const double up_part = longest->accel_m_s2.normalized().dot(longest->mag_tesla.normalized());
    reference.dip_rad = -std::asin(std::clamp(up_part, -1.0, 1.0));
  }
  return reference;
}

SessionReference CommonReference(std::span<const SessionReference> sensors,
                                 const SessionConfig& config) {
  std::vector<SessionReference> with_mag;
  for (const SessionReference& sensor : sensors) {
    if (sensor.field_tesla > 0.0) {
      with_mag.push_back(sensor);
    }
  }
  SessionReference common;
  common.declination_rad = config.declination_rad;
  common.gravity_m_s2 =
      MedianOf(sensors, [](const SessionReference& sensor) { return sensor.gravity_m_s2; });
  common.field_tesla =
      config.expected_field_tesla > 0.0 && !with_mag.empty()
          ? config.expected_field_tesla
          : MedianOf(with_mag, [](const SessionReference& sensor) { return sensor.field_tesla; });
  common.dip_rad =
      MedianOf(with_mag, [](const SessionReference& sensor) { return sensor.dip_rad; });
  common.rest_s = MedianOf(sensors, [](const SessionReference& sensor) { return sensor.rest_s; });
  return common;
}

std::vector<FieldVerdict> JudgeField(std::span<const SessionReference> sensors,
                                     const SessionConfig& config) {
  const SessionReference common = CommonReference(sensors, config);
  std::vector<FieldVerdict> verdicts;
  for (const SessionReference& sensor : sensors) {
    FieldVerdict verdict;
    if (sensor.field_tesla > 0.0) {
      if (std::abs(sensor.field_tesla / common.field_tesla - 1.0) > config.max_field_error) {
        verdict.reason = "field " + NumberText(sensor.field_tesla * kMicroTesla, 1) +
                         " uT, expected " + NumberText(common.field_tesla * kMicroTesla, 1) + " uT";
      }
      if (std::abs(sensor.dip_rad - common.dip_rad) > config.max_dip_error_rad) {
        verdict.reason += (verdict.reason.empty() ? "dip " : "; dip ") +
                          NumberText(sensor.dip_rad * kDegPerRad, 1) + " deg, expected " +
                          NumberText(common.dip_rad * kDegPerRad, 1) + " deg";
      }
      verdict.disturbed = !verdict.reason.empty();
    }
    verdicts.push_back(verdict);
  }
  return verdicts;
}

}  // namespace limbcast::sensing
