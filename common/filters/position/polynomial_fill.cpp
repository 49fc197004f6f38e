#include "common/filters/position/polynomial_fill.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace limbcast::filters {
namespace {

constexpr int kEnoughForParabola = 5;

}  // namespace

std::optional<GapEnd> FitGapEnd(std::span<const SeenMarker> markers, Time at, bool before,
                                double window_s) {
  const Duration window = DurationFromSeconds(window_s);
  const Time from = before ? at - window : at;
  const Time to = before ? at : at + window;
  const auto begin = std::lower_bound(markers.begin(), markers.end(), from,
                                      [](const SeenMarker& m, Time t) { return m.at < t; });
  int n = 0;
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d b = Eigen::Matrix3d::Zero();  // a column for each axis
  for (auto m = begin; m != markers.end() && m->at <= to; ++m) {
    const double t = ToSeconds(m->at - at) / window_s;
    const Eigen::Vector3d row(1.0, t, t * t);
    A += row * row.transpose();
    b += row * m->p_earth_marker_m.transpose();
    ++n;
  }
  if (n == 0) {
    return std::nullopt;
  }
  const int terms = n >= kEnoughForParabola ? 3 : (n >= 2 ? 2 : 1);
  Eigen::Matrix3d x = Eigen::Matrix3d::Zero();
  x.topRows(terms) = A.topLeftCorner(terms, terms).ldlt().solve(b.topRows(terms));
  return GapEnd{at, x.row(0).transpose(), x.row(1).transpose() / window_s};
}

Eigen::Vector3d HermiteFill(const GapEnd& from, const GapEnd& to, Time at) {
  const double length_s = ToSeconds(to.at - from.at);
  if (!(length_s > 0.0)) {
    return from.p_m;
  }
  const double u = ToSeconds(at - from.at) / length_s;
  const double u2 = u * u;
  const double u3 = u2 * u;
  return (2.0 * u3 - 3.0 * u2 + 1.0) * from.p_m + (u3 - 2.0 * u2 + u) * length_s * from.v_m_s +
         (3.0 * u2 - 2.0 * u3) * to.p_m + (u3 - u2) * length_s * to.v_m_s;
}

}  // namespace limbcast::filters
