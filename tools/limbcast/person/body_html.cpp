#include "tools/limbcast/person/body_html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "common/body/joint_angles.hpp"
#include "common/units/units.hpp"
#include "tools/limbcast/report/report_text.hpp"

namespace limbcast::tool {
namespace {

constexpr double kWidth = 1100.0;
constexpr double kHeight = 220.0;
constexpr double kLow_deg = -45.0;
constexpr double kHigh_deg = 115.0;
constexpr std::size_t kMaxPoints = 4000;

struct Plot {
  const char* title;
  body::Joint right;
  body::Joint left;
};
constexpr std::array<Plot, 3> kPlots = {{
    {"hip flexion", body::Joint::kRightHip, body::Joint::kLeftHip},
    {"knee flexion", body::Joint::kRightKnee, body::Joint::kLeftKnee},
    {"ankle dorsiflexion", body::Joint::kRightAnkle, body::Joint::kLeftAnkle},
}};

double Y(double angle_deg) {
  const double share =
      (std::clamp(angle_deg, kLow_deg, kHigh_deg) - kLow_deg) / (kHigh_deg - kLow_deg);
  return kHeight * (1.0 - share);
}

std::string Curve(const BodyTrace& trace, body::Joint joint, const char* colour) {
  const double end_s = std::max(trace.frames.back().time_s, 1e-3);
  const std::size_t every = std::max<std::size_t>(1, trace.frames.size() / kMaxPoints);
  std::string points;
  for (std::size_t i = 0; i < trace.frames.size(); i += every) {
    const BodyFrame& frame = trace.frames[i];
    if (!Knows(frame, joint)) {
      continue;
    }
    const double angle_deg = units::DegFromRad(JointAngle_rad(frame, joint, 0));
    points += fmt::format("{:.1f},{:.1f} ", kWidth * frame.time_s / end_s, Y(angle_deg));
  }
  return fmt::format("<polyline fill='none' stroke='{}' stroke-width='1' points='{}'/>\n", colour,
                     points);
}

std::string Chart(const BodyTrace& trace, const Plot& plot) {
  std::string svg = fmt::format(
      "<h3>{} <small>(degrees; <span class='r'>right</span>, <span class='l'>left</span>)</small>"
      "</h3>\n<svg viewBox='-40 -5 {} {}' width='100%'>\n",
      plot.title, kWidth + 50.0, kHeight + 30.0);
  for (int angle_deg = -30; angle_deg <= 90; angle_deg += 30) {
    svg += fmt::format(
        "<line x1='0' x2='{0}' y1='{1:.1f}' y2='{1:.1f}' stroke='#ddd'/><text x='-35' y='{1:.1f}' "
        "font-size='11'>{2}</text>\n",
        kWidth, Y(angle_deg), angle_deg);
  }
  const double end_s = std::max(trace.frames.back().time_s, 1e-3);
  const double step_s = std::max(1.0, std::ceil(end_s / 20.0));
  for (double t_s = 0.0; t_s <= end_s; t_s += step_s) {
    svg += fmt::format("<text x='{:.1f}' y='{}' font-size='11'>{:.0f} s</text>\n",
                       kWidth * t_s / end_s, kHeight + 15.0, t_s);
  }
  return svg + Curve(trace, plot.right, "#c0392b") + Curve(trace, plot.left, "#2471a3") +
         "</svg>\n";
}

}  // namespace

std::string BodyHtml(const std::string& title, const BodyTrace& trace,
                     const std::vector<BodyFigure>& figures) {
  std::string page = fmt::format(
      "<!doctype html><meta charset='utf-8'><title>{0}</title><style>body{{font-family:sans-serif;"
      "margin:2em;max-width:1150px}}td{{padding:0 1em 0 0}}.r{{color:#c0392b}}.l{{color:#2471a3}}"
      ".no{{color:#c0392b;font-weight:bold}}</style><h1>{0}</h1>\n<ul>\n",
      EscapedHtml(title));
  for (const std::string& event : trace.events) {
    page += "<li>" + EscapedHtml(event) + "</li>\n";
  }
  page += "</ul>\n";
  if (!trace.frames.empty()) {
    for (const Plot& plot : kPlots) {
      page += Chart(trace, plot);
    }
  }
  page += "<table>\n";
  for (const BodyFigure& figure : figures) {
    page += fmt::format("<tr><td>{}</td><td class='{}'>{:.1f}</td><td>{:.0f} to {:.0f}</td></tr>\n",
                        EscapedHtml(figure.name), figure.holds() ? "yes" : "no", figure.value,
                        figure.low, figure.high);
  }
  return page + "</table>\n";
}

}  // namespace limbcast::tool
