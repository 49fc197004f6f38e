#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "common/sensing/marg_sample.hpp"

namespace limbcast::sensing {

/// When a sensor counts as lying still.
struct RestConfig {
  /// Samples are judged in blocks of this length. Range: [0.05, 5].
  double block_s = 0.25;
  /// Largest standard deviation of each gyro axis within a block. Range: (0, 1].
  double gyro_sigma_rad_s = 0.03;
  /// Largest standard deviation of each accelerometer axis within a block. Range: (0, 5].
  double accel_sigma_m_s2 = 0.15;
  /// A block whose mean rate differs by more from the median of all still blocks turns slowly: not
  /// at rest. Range: (0, 1].
  double slow_turn_rad_s = 0.02;
  /// Still blocks further apart in mean specific force are two poses. Range: (0, 2].
  double same_pose_m_s2 = 0.10;
  /// Shorter poses are left out. Range: [0.05, 60].
  double min_pose_s = 0.5;
};

/// One time at rest: the samples [begin, end) and their means, raw.
struct RestPose {
  std::size_t begin = 0;
  std::size_t end = 0;
  Eigen::Vector3d gyro_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d mag_tesla = Eigen::Vector3d::Zero();
  std::size_t mag_count = 0;  ///< fresh magnetometer readings; 0: mag_tesla means nothing
};

/// Whether that reading is there and fresh, neither clipped nor spoiled by a coil pulse.
[[nodiscard]] bool HasGyroAndAccel(const MargSample& sample);
[[nodiscard]] bool HasFreshMag(const MargSample& sample);

/// The poses in which one sensor's samples (in order of time) were at rest. Blocks that lack the
/// gyro or the accelerometer, or with a hole in time, are none. Tedaldi et al. 2014, section IV
/// (static detector), with blocks in place of a sliding window.
[[nodiscard]] std::vector<RestPose> FindRestPoses(std::span<const MargSample> samples,
                                                  const RestConfig& config = {});

}  // namespace limbcast::sensing
