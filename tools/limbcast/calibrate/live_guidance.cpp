#include "tools/limbcast/calibrate/live_guidance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

namespace limbcast::tool {
namespace {

constexpr double kBlock_s = 0.5;
constexpr std::size_t kEnoughPoses = 18;
constexpr double kEnoughCoverage = 0.9;
constexpr double kNewPoseCos = 0.966;  // 15° from the pose before

}  // namespace

void LiveGuidance::Add(const sensing::MargSample& sample) {
  samples_.push_back(sample);
  constexpr std::size_t kEvery = 5;
  if (samples_.size() % kEvery == 0 && sensing::HasFreshMag(sample)) {
    mag_tesla_.emplace_back(sample.mag_tesla.cast<double>());
  }
  const Duration length = sample.measured_at - samples_[block_begin_].measured_at;
  if (length >= DurationFromSeconds(kBlock_s)) {
    EndBlock();
  }
}

// A still block is a pose, unless it goes on with the one before.
void LiveGuidance::EndBlock() {
  const std::span<const sensing::MargSample> block =
      std::span(samples_).subspan(block_begin_, samples_.size() - block_begin_);
  const auto poses = sensing::FindRestPoses(block, {.min_pose_s = 0.3});
  still_ = poses.size() == 1;
  if (still_) {
    const Eigen::Vector3d up = poses.front().accel_m_s2.normalized();
    poses_ += up.dot(last_up_) < kNewPoseCos ? 1U : 0U;
    last_up_ = up;
    gravity_.Add(up);
  }
  block_begin_ = samples_.size() - 1;
}

sensing::SphereCoverage LiveGuidance::FieldCoverage() const {
  constexpr double kLeastHalf_tesla = 10e-6;  // the weakest field on earth is 22 µT
  sensing::SphereCoverage coverage;
  if (mag_tesla_.empty()) {
    return coverage;
  }
  Eigen::Vector3d low = mag_tesla_.front();
  Eigen::Vector3d high = low;
  for (const Eigen::Vector3d& mag : mag_tesla_) {
    low = low.cwiseMin(mag);
    high = high.cwiseMax(mag);
  }
  const Eigen::Vector3d half = (high - low) / 2.0;
  if (half.minCoeff() < std::max(kLeastHalf_tesla, 0.5 * half.maxCoeff())) {
    return coverage;
  }
  for (const Eigen::Vector3d& mag : mag_tesla_) {
    coverage.Add(mag - (low + high) / 2.0);
  }
  return coverage;
}

bool LiveGuidance::complete() const {
  return poses_ >= kEnoughPoses && gravity_.share() >= kEnoughCoverage &&
         (mag_tesla_.empty() || FieldCoverage().share() >= kEnoughCoverage);
}

std::string LiveGuidance::Line() const {
  constexpr std::array<const char*, 6> kFaces = {"+x", "-x", "+y", "-y", "+z", "-z"};
  std::string line = fmt::format("{} poses, up:", poses_);
  const auto faces = gravity_.faces();
  std::string next;
  for (std::size_t face = 0; face < faces.size(); ++face) {
    line += fmt::format(" {}", faces[face] ? kFaces[face] : "..");
    next = next.empty() && !faces[face] ? kFaces[face] : next;
  }
  line += fmt::format(", gravity {:.0f} %", 100.0 * gravity_.share());
  line += mag_tesla_.empty() ? std::string(", no magnetometer")
                             : fmt::format(", field {:.0f} %", 100.0 * FieldCoverage().share());
  if (complete()) {
    return line + "; enough: Ctrl-C ends";
  }
  const std::string words = gravity_.MissingWords();
  next = next.empty() ? words.substr(0, words.find(',')) : next;
  line += still_ ? "; seen, turn on" : "; hold still for 1 s";
  return next.empty() ? line + ": any new pose" : line + ": next " + next + " up";
}

}  // namespace limbcast::tool
