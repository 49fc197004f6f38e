#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/time.hpp"
#include "common/body/joint_angle_frame.hpp"

namespace limbcast::tool {

enum class AngleFormat {
  kCsv,
  kMot,  ///< OpenSim's Storage, "inDegrees=no"
};

/// The format that a file's name asks for: ".mot", ".sto", everything else CSV.
[[nodiscard]] AngleFormat AngleFormatOf(std::string_view path);

/// The joint angles of one person over time, a row for each frame; times count from the first.
/// Thread-compatible.
class AngleTable {
 public:
  /// Frames that are not newer than the last are left out, so that the times of a file rise.
  void Add(const body::JointAngleFrame& frame);

  [[nodiscard]] std::size_t rows() const { return rows_.size(); }
  /// The whole file. `title` is the name of the motion, one line.
  [[nodiscard]] std::string Text(AngleFormat format, std::string_view title) const;

 private:
  static constexpr std::size_t kAngles = 3 * body::kJointCount;
  struct Row {
    Time measured_at{};
    std::array<float, kAngles> angle_rad{};  // NaN: the body lacks a segment
    std::array<float, body::kJointCount> confidence{};
  };
  std::vector<Row> rows_;
};

}  // namespace limbcast::tool
