#include "common/filters/position/position_series.hpp"

#include <algorithm>
#include <optional>

#include "common/math/rotation.hpp"

namespace limbcast::filters {
namespace {

constexpr double kMaxEpochs_s = 0.05;
constexpr double kMaxPolynomial_s = 0.1;
constexpr double kPolynomialSigma_m = 1e-3;
constexpr double kUnseenAccel_m_s2 = 5.0;

PositionEstimate Between(const PositionEstimate& a, const PositionEstimate& b, Time at) {
  const double u = ToSeconds(at - a.at) / ToSeconds(b.at - a.at);
  const Eigen::Vector3d lever_a = a.p_earth_marker_m - a.p_earth_sensor_m;
  const Eigen::Vector3d lever_b = b.p_earth_marker_m - b.p_earth_sensor_m;
  PositionEstimate out = u < 0.5 ? a : b;
  out.at = at;
  out.p_earth_sensor_m = HermiteFill({a.at, a.p_earth_sensor_m, a.v_earth_sensor_m_s},
                                     {b.at, b.p_earth_sensor_m, b.v_earth_sensor_m_s}, at);
  out.p_earth_marker_m = out.p_earth_sensor_m + (1.0 - u) * lever_a + u * lever_b;
  out.v_earth_sensor_m_s = (1.0 - u) * a.v_earth_sensor_m_s + u * b.v_earth_sensor_m_s;
  out.accel_in_earth_m_s2 = (1.0 - u) * a.accel_in_earth_m_s2 + u * b.accel_in_earth_m_s2;
  out.q_earth_sensor = math::Slerp(a.q_earth_sensor, b.q_earth_sensor, u);
  out.degraded = a.degraded || b.degraded;
  if (out.fill == FillKind::kMeasured && a.at != at && b.at != at) {
    out.fill = FillKind::kInertialSmoothed;
  }
  return out;
}

std::optional<PositionEstimate> Polynomial(std::span<const SeenMarker> markers, Time at) {
  const auto after = std::lower_bound(markers.begin(), markers.end(), at,
                                      [](const SeenMarker& m, Time t) { return m.at < t; });
  if (after == markers.end() || (after == markers.begin() && after->at != at)) {
    return std::nullopt;
  }
  PositionEstimate out;
  out.at = at;
  double sigma_m = kPolynomialSigma_m;
  if (after->at == at) {
    out.fill = FillKind::kMeasured;
    out.p_earth_marker_m = after->p_earth_marker_m;
  } else {
    const auto before = std::prev(after);
    const double length_s = ToSeconds(after->at - before->at);
    if (length_s > kMaxPolynomial_s) {
      return std::nullopt;
    }
    const auto from = FitGapEnd(markers, before->at, true);
    const auto to = FitGapEnd(markers, after->at, false);
    out.fill = FillKind::kPolynomial;
    out.p_earth_marker_m = HermiteFill(*from, *to, at);
    sigma_m += kUnseenAccel_m_s2 * length_s * length_s / 32.0;
  }
  out.degraded = true;
  out.has_motion = false;
  out.p_earth_sensor_m = out.p_earth_marker_m;
  out.cov_position_m2 = sigma_m * sigma_m / 3.0 * Eigen::Matrix3d::Identity();
  return out;
}

}  // namespace

std::vector<PositionEstimate> SeriesAt(std::span<const PositionEstimate> estimates,
                                       std::span<const Time> rows,
                                       std::span<const SeenMarker> markers) {
  std::vector<PositionEstimate> out;
  out.reserve(rows.size());
  std::size_t next = 0;  // first epoch at or after the row
  for (const Time at : rows) {
    while (next < estimates.size() && estimates[next].at < at) {
      ++next;
    }
    if (next < estimates.size() && estimates[next].at == at) {
      out.push_back(estimates[next]);
      continue;
    }
    const bool inside = next > 0 && next < estimates.size();
    const bool close =
        inside && ToSeconds(estimates[next].at - estimates[next - 1].at) <= kMaxEpochs_s;
    if (!close) {
      if (const auto polynomial = Polynomial(markers, at)) {
        out.push_back(*polynomial);
        continue;
      }
    }
    if (inside) {
      out.push_back(Between(estimates[next - 1], estimates[next], at));
    } else {
      out.emplace_back();
      out.back().at = at;
      out.back().has_motion = false;
    }
  }
  return out;
}

}  // namespace limbcast::filters
