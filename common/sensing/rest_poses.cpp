#include "common/sensing/rest_poses.hpp"

#include <algorithm>
#include <cmath>

namespace limbcast::sensing {
namespace {

struct Moments {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d square = Eigen::Vector3d::Zero();
  double count = 0.0;

  void Add(const Eigen::Vector3d& value) {
    count += 1.0;
    const Eigen::Vector3d step = value - mean;
    mean += step / count;
    square += step.cwiseProduct(value - mean);
  }
  [[nodiscard]] double LargestSigma() const { return std::sqrt(square.maxCoeff() / count); }
};

void AddMean(Eigen::Vector3d& mean, double count, const Eigen::Vector3d& more, double more_count) {
  if (more_count > 0.0) {
    mean += (more - mean) * (more_count / (count + more_count));
  }
}

// The block [begin, end) as a pose, if it is still; mag_count and means filled.
bool IsStill(std::span<const MargSample> samples, const RestConfig& config, RestPose& pose) {
  Moments gyro;
  Moments accel;
  Moments mag;
  for (std::size_t i = pose.begin; i < pose.end; ++i) {
    if (!HasGyroAndAccel(samples[i])) {
      return false;
    }
    gyro.Add(samples[i].gyro_rad_s.cast<double>());
    accel.Add(samples[i].accel_m_s2.cast<double>());
    if (HasFreshMag(samples[i])) {
      mag.Add(samples[i].mag_tesla.cast<double>());
    }
  }
  pose.gyro_rad_s = gyro.mean;
  pose.accel_m_s2 = accel.mean;
  pose.mag_tesla = mag.mean;
  pose.mag_count = static_cast<std::size_t>(mag.count);
  return gyro.LargestSigma() <= config.gyro_sigma_rad_s &&
         accel.LargestSigma() <= config.accel_sigma_m_s2;
}

std::vector<RestPose> StillBlocks(std::span<const MargSample> samples, const RestConfig& config) {
  constexpr std::size_t kFewest = 4;
  std::vector<RestPose> blocks;
  std::size_t begin = 0;
  while (begin < samples.size()) {
    const Time until = samples[begin].measured_at + DurationFromSeconds(config.block_s);
    std::size_t end = begin + 1;
    while (end < samples.size() && samples[end].measured_at < until) {
      ++end;
    }
    RestPose block{.begin = begin, .end = end};
    const double length_s = ToSeconds(samples[end - 1].measured_at - samples[begin].measured_at);
    if (end - begin >= kFewest && length_s > 0.5 * config.block_s &&
        IsStill(samples, config, block)) {
      blocks.push_back(block);
    }
    begin = end;
  }
  return blocks;
}

Eigen::Vector3d MedianRate(const std::vector<RestPose>& blocks) {
  Eigen::Vector3d median = Eigen::Vector3d::Zero();
  std::vector<double> values(blocks.size());
  for (Eigen::Index axis = 0; axis < 3 && !blocks.empty(); ++axis) {
    std::transform(blocks.begin(), blocks.end(), values.begin(),
                   [axis](const RestPose& block) { return block.gyro_rad_s(axis); });
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    median(axis) = *middle;
  }
  return median;
}

void Append(RestPose& pose, const RestPose& block) {
  const auto count = static_cast<double>(pose.end - pose.begin);
  const auto more = static_cast<double>(block.end - block.begin);
  AddMean(pose.gyro_rad_s, count, block.gyro_rad_s, more);
  AddMean(pose.accel_m_s2, count, block.accel_m_s2, more);
  AddMean(pose.mag_tesla, static_cast<double>(pose.mag_count), block.mag_tesla,
          static_cast<double>(block.mag_count));
  pose.mag_count += block.mag_count;
  pose.end = block.end;
}

}  // namespace

bool HasGyroAndAccel(const MargSample& sample) {
  constexpr std::uint32_t kBad =
      kGyroMissing | kAccelMissing | kGyroSaturated | kAccelSaturated | kProbe;
  return (sample.flags & kBad) == 0 && sample.gyro_rad_s.allFinite() &&
         sample.accel_m_s2.allFinite();
}

bool HasFreshMag(const MargSample& sample) {
  constexpr std::uint32_t kBad = kMagMissing | kMagSaturated | kMagHeld | kCoilPulseActive | kProbe;
  return (sample.flags & kBad) == 0 && sample.mag_tesla.allFinite();
}

std::vector<RestPose> FindRestPoses(std::span<const MargSample> samples, const RestConfig& config) {
  const std::vector<RestPose> blocks = StillBlocks(samples, config);
  const Eigen::Vector3d rate = MedianRate(blocks);
  std::vector<RestPose> poses;
  for (const RestPose& block : blocks) {
    if ((block.gyro_rad_s - rate).norm() > config.slow_turn_rad_s) {
      continue;
    }
    if (!poses.empty() && poses.back().end == block.begin &&
        (poses.back().accel_m_s2 - block.accel_m_s2).norm() < config.same_pose_m_s2) {
      Append(poses.back(), block);
    } else {
      poses.push_back(block);
    }
  }
  std::erase_if(poses, [&](const RestPose& pose) {
    return ToSeconds(samples[pose.end - 1].measured_at - samples[pose.begin].measured_at) <
           config.min_pose_s - config.block_s / 2.0;
  });
  return poses;
}

}  // namespace limbcast::sensing
