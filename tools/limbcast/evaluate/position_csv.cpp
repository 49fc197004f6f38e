#include "tools/limbcast/evaluate/position_csv.hpp"

#include <fmt/format.h>

#include "common/math/rotation.hpp"

namespace limbcast::tool {
namespace {

using filters::FillKind;

constexpr const char* kHeader =
    "time_s,fill,degraded,sigma_position_m,"
    "p_earth_marker_x_m,p_earth_marker_y_m,p_earth_marker_z_m,"
    "p_earth_sensor_x_m,p_earth_sensor_y_m,p_earth_sensor_z_m,"
    "v_earth_sensor_x_m_s,v_earth_sensor_y_m_s,v_earth_sensor_z_m_s,"
    "accel_in_earth_x_m_s2,accel_in_earth_y_m_s2,accel_in_earth_z_m_s2,"
    "q_earth_sensor_w,q_earth_sensor_x,q_earth_sensor_y,q_earth_sensor_z\n";

void AddVector(fmt::memory_buffer& text, const Eigen::Vector3d& v) {
  fmt::format_to(std::back_inserter(text), ",{:.7g},{:.7g},{:.7g}", v.x(), v.y(), v.z());
}

}  // namespace

std::string PositionCsv(std::span<const filters::PositionEstimate> estimates) {
  fmt::memory_buffer text;
  fmt::format_to(std::back_inserter(text), "{}", kHeader);
  for (const filters::PositionEstimate& e : estimates) {
    fmt::format_to(std::back_inserter(text), "{:.9g},{}", ToSeconds(e.at - Time{}),
                   ToString(e.fill));
    if (e.fill == FillKind::kNone) {
      fmt::format_to(std::back_inserter(text), ",,,,,,,,,,,,,,,,,,\n");
      continue;
    }
    fmt::format_to(std::back_inserter(text), ",{},{:.4g}", e.degraded ? 1 : 0,
                   e.sigma_position_m());
    AddVector(text, e.p_earth_marker_m);
    if (!e.has_motion) {
      fmt::format_to(std::back_inserter(text), ",,,,,,,,,,,,,\n");
      continue;
    }
    AddVector(text, e.p_earth_sensor_m);
    AddVector(text, e.v_earth_sensor_m_s);
    AddVector(text, e.accel_in_earth_m_s2);
    const Eigen::Quaterniond q = math::Canonical(e.q_earth_sensor);
    fmt::format_to(std::back_inserter(text), ",{:.7g},{:.7g},{:.7g},{:.7g}\n", q.w(), q.x(), q.y(),
                   q.z());
  }
  return fmt::to_string(text);
}

std::string SmoothSummary(const filters::OfflineResult& result) {
  if (result.estimates.empty()) {
    return "never started: no rest and motion with a visible marker to find the attitude from\n";
  }
  const filters::OpticalInertialState& x = result.start;
  std::string text = fmt::format(
      "from {:.3f} s on{}\n", ToSeconds(result.estimates.front().at - Time{}),
      result.began_at_rest ? " (the rest before the motion)" : " (no rest before the motion)");
  text += fmt::format(
      "marker on the sensor: ({:.2f}, {:.2f}, {:.2f}) mm, stamps lead by {:.2f} ms, "
      "gyro later than accelerometer by {:.2f} ms\n",
      1e3 * x.p_sensor_marker_m.x(), 1e3 * x.p_sensor_marker_m.y(), 1e3 * x.p_sensor_marker_m.z(),
      1e3 * x.marker_lead_s, 1e3 * x.errors.gyro_delay_s);
  using filters::MarkerVerdict;
  text += fmt::format(
      "markers: {} fused, {} downweighted, {} outliers, {} foreign, {} hidden, {} "
      "repeated, {} more than one in a block\n",
      result.markers[MarkerVerdict::kFused], result.markers[MarkerVerdict::kDownweighted],
      result.markers[MarkerVerdict::kOutlier], result.markers[MarkerVerdict::kForeign],
      result.markers[MarkerVerdict::kHidden], result.markers[MarkerVerdict::kRepeated],
      result.markers[MarkerVerdict::kSuperseded]);
  return text;
}

}  // namespace limbcast::tool
