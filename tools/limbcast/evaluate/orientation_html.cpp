#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/limbcast/evaluate/orientation_report.hpp"
#include "tools/limbcast/report/report_text.hpp"

namespace limbcast::tool {
namespace {

constexpr double kWidth = 880.0;
constexpr double kHeight = 180.0;
constexpr double kLeft = 46.0;
constexpr double kBottom = 22.0;
constexpr std::array<const char*, 6> kColours = {"#0b6e99", "#c4572e", "#3d8f4f",
                                                 "#8a5aa8", "#a98600", "#555555"};

std::string ColourOf(const ReportHead& head, const std::string& filter) {
  const auto at = std::find(head.filters.begin(), head.filters.end(), filter);
  return kColours[static_cast<std::size_t>(at - head.filters.begin()) % kColours.size()];
}

// One plot: time to the right, total error upward; grey where the trial is not scored.
std::string Plot(const ReportHead& head, std::span<const OrientationResult* const> results) {
  double end_s = 1e-9;
  double top_deg = 1.0;
  for (const OrientationResult* r : results) {
    end_s = std::max(end_s, r->points.empty() ? 0.0 : r->points.back().time_s);
    for (const ErrorPoint& p : r->points) {
      top_deg = p.scored ? std::max(top_deg, p.total_deg) : top_deg;
    }
  }
  top_deg = std::ceil(std::min(top_deg, 180.0));
  const auto x = [end_s](double t) { return kLeft + t / end_s * (kWidth - kLeft); };
  const auto y = [top_deg](double e) {
    return (kHeight - kBottom) * (1.0 - std::min(e / top_deg, 1.0));
  };
  std::string svg = fmt::format("<svg viewBox='0 0 {} {}'>", kWidth, kHeight);
  const std::vector<ErrorPoint>& first = results.front()->points;
  for (std::size_t i = 0; i + 1 < first.size(); ++i) {
    if (!first[i].scored) {
      svg += fmt::format("<rect x='{:.1f}' y='0' width='{:.1f}' height='{}' fill='#eee'/>",
                         x(first[i].time_s), x(first[i + 1].time_s) - x(first[i].time_s) + 0.2,
                         kHeight - kBottom);
    }
  }
  for (int line = 0; line <= 4; ++line) {
    const double e = top_deg * line / 4.0;
    svg += fmt::format(
        "<path d='M{0} {1:.1f}H{2}' stroke='#ccc'/><text x='{3}' y='{4:.1f}'>{5:.3g}°</text>",
        kLeft, y(e), kWidth, 2, y(e) + 9.0, e);
  }
  for (int tick = 0; tick <= 8; ++tick) {
    const double t = end_s * tick / 8.0;
    svg += fmt::format("<text x='{:.1f}' y='{}'>{:.0f} s</text>", x(t) - (tick == 8 ? 30.0 : 0.0),
                       kHeight - 6.0, t);
  }
  for (const OrientationResult* r : results) {
    // A path that begins anew after a stretch without truth.
    svg += fmt::format("<path fill='none' stroke='{}' d='", ColourOf(head, r->filter));
    bool drawing = false;
    for (const ErrorPoint& p : r->points) {
      if (p.known) {
        svg += fmt::format("{}{:.1f},{:.1f} ", drawing ? 'L' : 'M', x(p.time_s), y(p.total_deg));
      }
      drawing = p.known;
    }
    svg += "'/>";
  }
  return svg + "</svg>";
}

std::string Legend(const ReportHead& head, std::span<const OrientationResult* const> results) {
  std::string text = "<p>";
  for (const OrientationResult* r : results) {
    text += fmt::format(
        "<span style='color:{}'>■</span> {}: total {:.2f}°, heading {:.2f}°, inclination {:.2f}°, "
        "largest {:.1f}°, NEES {:.2f} of 3 &nbsp; ",
        ColourOf(head, r->filter), EscapedHtml(r->filter), r->errors.total_rms_deg(),
        r->errors.heading_rms_deg(), r->errors.inclination_rms_deg(), r->errors.total_max_deg(),
        r->mean_nees);
  }
  return text + "</p>";
}

}  // namespace

std::string OrientationHtml(const ReportHead& head, std::span<const OrientationResult> results) {
  std::string html =
      "<!doctype html><html lang='en'><head><meta charset='utf-8'><title>Orientation "
      "errors</title><style>body{font:14px sans-serif;max-width:920px;margin:2em auto}svg{width:"
      "100%}text{font-size:10px;fill:#555}pre{overflow-x:auto;font-size:12px}</style></head><body>"
      "<h1>Orientation errors</h1><p>Total error over time; grey: not scored; gaps: truth not "
      "known.</p><pre>";
  html += EscapedHtml(OrientationTable(head, results)) + "</pre>";
  std::vector<std::string> trials;
  for (const OrientationResult& r : results) {
    if (std::find(trials.begin(), trials.end(), r.trial) == trials.end()) {
      trials.push_back(r.trial);
    }
  }
  for (const std::string& trial : trials) {
    std::vector<const OrientationResult*> of_trial;
    for (const OrientationResult& r : results) {
      if (r.trial == trial) {
        of_trial.push_back(&r);
      }
    }
    html += "<h2>" + EscapedHtml(trial) + "</h2>" + Plot(head, of_trial) + Legend(head, of_trial);
  }
  return html + "</body></html>\n";
}

}  // namespace limbcast::tool
