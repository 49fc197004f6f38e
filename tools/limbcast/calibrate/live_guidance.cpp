#include "tools/limbcast/calibrate/live_guidance.hpp"

#include <fmt/format.h>

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
  if (sensing::HasFreshMag(sample)) {
    const Eigen::Vector3d mag = sample.mag_tesla.cast<double>();
    mag_min_tesla_ = has_mag_ ? Eigen::Vector3d(mag_min_tesla_.cwiseMin(mag)) : mag;
    mag_max_tesla_ = has_mag_ ? Eigen::Vector3d(mag_max_tesla_.cwiseMax(mag)) : mag;
    has_mag_ = true;
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
  if (has_mag_ && samples_.back().mag_tesla.allFinite()) {
    // About the middle of what was seen: the offset is not known yet.
    for (const sensing::MargSample& sample : block) {
      if (sensing::HasFreshMag(sample)) {
        field_.Add(sample.mag_tesla.cast<double>() - (mag_min_tesla_ + mag_max_tesla_) / 2.0);
      }
    }
  }
  block_begin_ = samples_.size() - 1;
}

bool LiveGuidance::complete() const {
  return poses_ >= kEnoughPoses && gravity_.share() >= kEnoughCoverage &&
         (!has_mag_ || field_.share() >= kEnoughCoverage);
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
  line += has_mag_ ? fmt::format(", field {:.0f} %", 100.0 * field_.share()) : ", no magnetometer";
  if (complete()) {
    return line + "; enough: Ctrl-C ends";
  }
  const std::string words = gravity_.MissingWords();
  next = next.empty() ? words.substr(0, words.find(',')) : next;
  line += still_ ? "; seen, turn on" : "; hold still for 1 s";
  return next.empty() ? line + ": any new pose" : line + ": next " + next + " up";
}

}  // namespace limbcast::tool
