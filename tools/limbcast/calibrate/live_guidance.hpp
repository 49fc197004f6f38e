#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/sensing/marg_sample.hpp"
#include "common/sensing/rest_poses.hpp"
#include "common/sensing/sphere_coverage.hpp"

namespace limbcast::tool {

/// What a person who turns one sensor by hand is told meanwhile. Collects the sensor's samples;
/// knows no clock and no terminal. Thread-compatible.
class LiveGuidance {
 public:
  /// Samples of one sensor, in order of time.
  void Add(const sensing::MargSample& sample);

  [[nodiscard]] const std::vector<sensing::MargSample>& samples() const { return samples_; }
  /// Poses at rest so far.
  [[nodiscard]] std::size_t poses() const { return poses_; }
  /// Enough for a fit by all that can be seen so far.
  [[nodiscard]] bool complete() const;

  /// One line: "14 poses, up: +x -x +y .. +z -z, gravity 71 %, field 88 %; hold still: next -y up".
  [[nodiscard]] std::string Line() const;

 private:
  void EndBlock();
  // Of the field's directions about the middle of its box; nothing while the box is flat or small,
  // for then the middle is not known.
  [[nodiscard]] sensing::SphereCoverage FieldCoverage() const;

  std::vector<sensing::MargSample> samples_;
  std::size_t block_begin_ = 0;
  bool still_ = false;
  Eigen::Vector3d last_up_ = Eigen::Vector3d::Zero();
  std::size_t poses_ = 0;
  sensing::SphereCoverage gravity_;
  std::vector<Eigen::Vector3d> mag_tesla_;  // some of the readings
};

}  // namespace limbcast::tool
