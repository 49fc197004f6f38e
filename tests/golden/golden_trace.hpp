#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/limbcast/evaluate/orientation_trial.hpp"

namespace limbcast::golden {

/// The recording that every filter is given: the left fore arm of the simulated person, 20 s at
/// 50 Hz with noise and iron, in the CSV layout of recordings.
inline constexpr const char* kInput = "left_fore_arm.csv";

/// What a filter is expected to say of every tenth sample.
struct Trace {
  std::vector<std::size_t> row;  ///< from 0
  std::vector<Eigen::Quaterniond> q_earth_sensor;
};

/// The sensor of `folder`/left_fore_arm.csv. Fails as reading a recording does.
[[nodiscard]] Result<tool::OrientationTrial> LoadInput(const std::filesystem::path& folder);

/// What the filter of that name, as shipped, says now.
[[nodiscard]] Trace Compute(const tool::OrientationTrial& input, const std::string& filter);

/// "row,w,x,y,z" with ten digits.
[[nodiscard]] std::string Format(const Trace& trace);
[[nodiscard]] Result<Trace> Load(const std::filesystem::path& file);

}  // namespace limbcast::golden
