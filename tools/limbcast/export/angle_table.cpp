#include "tools/limbcast/export/angle_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <limits>

namespace limbcast::tool {
namespace {

void AppendAngleNames(char separator, std::string& text) {
  for (std::size_t i = 0; i < body::kJointCount; ++i) {
    const auto joint = static_cast<body::Joint>(i);
    for (const std::string_view angle : body::AngleNames(joint)) {
      fmt::format_to(std::back_inserter(text), "{}{}_{}_rad", separator, body::ToString(joint),
                     angle);
    }
  }
}

}  // namespace

AngleFormat AngleFormatOf(std::string_view path) {
  return path.ends_with(".mot") || path.ends_with(".sto") ? AngleFormat::kMot : AngleFormat::kCsv;
}

void AngleTable::Add(const body::JointAngleFrame& frame) {
  if (!rows_.empty() && frame.measured_at <= rows_.back().measured_at) {
    return;
  }
  Row row;
  row.measured_at = frame.measured_at;
  row.angle_rad.fill(std::numeric_limits<float>::quiet_NaN());
  for (const body::JointAngle& joint : frame.joints) {
    const std::size_t i = body::Index(joint.joint);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      row.angle_rad[3 * i + axis] = joint.angle_rad[static_cast<Eigen::Index>(axis)];
    }
    row.confidence[i] = joint.confidence;
  }
  rows_.push_back(row);
}

std::string AngleTable::Text(AngleFormat format, std::string_view title) const {
  const bool csv = format == AngleFormat::kCsv;
  const char separator = csv ? ',' : '\t';
  std::string text;
  if (csv) {
    text = "time_s";
  } else {
    text = fmt::format("{}\nversion=1\nnRows={}\nnColumns={}\ninDegrees=no\n\nendheader\ntime",
                       title, rows_.size(), 1 + kAngles);
  }
  AppendAngleNames(separator, text);
  if (csv) {
    for (std::size_t i = 0; i < body::kJointCount; ++i) {
      fmt::format_to(std::back_inserter(text), ",{}_confidence",
                     body::ToString(static_cast<body::Joint>(i)));
    }
  }
  text += '\n';
  for (const Row& row : rows_) {
    fmt::format_to(std::back_inserter(text), "{:.6f}",
                   ToSeconds(row.measured_at - rows_.front().measured_at));
    for (const float angle_rad : row.angle_rad) {
      text += separator;
      if (!std::isnan(angle_rad)) {
        fmt::format_to(std::back_inserter(text), "{:.6f}", angle_rad);
      } else if (!csv) {
        text += "nan";
      }
    }
    if (csv) {
      for (const float confidence : row.confidence) {
        fmt::format_to(std::back_inserter(text), ",{:.3f}", confidence);
      }
    }
    text += '\n';
  }
  return text;
}

}  // namespace limbcast::tool
