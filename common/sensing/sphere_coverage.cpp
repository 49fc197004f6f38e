#include "common/sensing/sphere_coverage.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/sensing/axis_words.hpp"

namespace limbcast::sensing {
namespace {

const double kReachCos = std::cos(SphereCoverage::kReach_rad);

std::array<Eigen::Vector3d, SphereCoverage::kProbes> MakeProbes() {
  std::array<Eigen::Vector3d, SphereCoverage::kProbes> probes;
  for (std::size_t i = 0; i < probes.size(); ++i) {
    const double z =
        1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(probes.size());
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / std::numbers::phi;
    const double r = std::sqrt(1.0 - z * z);
    probes[i] = {r * std::cos(angle), r * std::sin(angle), z};
  }
  return probes;
}

}  // namespace

const std::array<Eigen::Vector3d, SphereCoverage::kProbes>& SphereCoverage::Probes() {
  static const auto probes = MakeProbes();
  return probes;
}

SphereCoverage::SphereCoverage() {
  nearest_cos_.fill(-1.0);
  face_cos_.fill(-1.0);
}

void SphereCoverage::Add(const Eigen::Vector3d& direction) {
  const double norm = direction.norm();
  if (!(norm > 0.0) || !std::isfinite(norm)) {
    return;
  }
  const Eigen::Vector3d unit = direction / norm;
  const auto& probes = Probes();
  for (std::size_t i = 0; i < kProbes; ++i) {
    nearest_cos_[i] = std::max(nearest_cos_[i], probes[i].dot(unit));
  }
  for (std::size_t face = 0; face < face_cos_.size(); ++face) {
    const double part = unit(static_cast<Eigen::Index>(face / 2));
    face_cos_[face] = std::max(face_cos_[face], face % 2 == 0 ? part : -part);
  }
}

std::array<bool, SphereCoverage::kProbes> SphereCoverage::covered() const {
  std::array<bool, kProbes> covered{};
  for (std::size_t i = 0; i < kProbes; ++i) {
    covered[i] = nearest_cos_[i] >= kReachCos;
  }
  return covered;
}

double SphereCoverage::share() const {
  const auto flags = covered();
  return static_cast<double>(std::count(flags.begin(), flags.end(), true)) /
         static_cast<double>(kProbes);
}

double SphereCoverage::widest_gap_rad() const {
  return std::acos(
      std::clamp(*std::min_element(nearest_cos_.begin(), nearest_cos_.end()), -1.0, 1.0));
}

Eigen::Vector3d SphereCoverage::gap_direction() const {
  const auto at = std::min_element(nearest_cos_.begin(), nearest_cos_.end());
  return Probes()[static_cast<std::size_t>(at - nearest_cos_.begin())];
}

std::array<bool, 6> SphereCoverage::faces() const {
  std::array<bool, 6> faces{};
  for (std::size_t face = 0; face < faces.size(); ++face) {
    faces[face] = face_cos_[face] >= kReachCos;
  }
  return faces;
}

std::string SphereCoverage::MissingWords() const {
  constexpr std::size_t kMost = 3;
  SphereCoverage left = *this;
  std::string words;
  for (std::size_t hole = 0; hole < kMost && left.widest_gap_rad() > kReach_rad; ++hole) {
    const Eigen::Vector3d direction = left.gap_direction();
    words += (words.empty() ? "" : ", ") + DirectionWords(direction);
    // As if it had been seen, and all within 60° with it: the next hole lies elsewhere.
    for (std::size_t i = 0; i < kProbes; ++i) {
      left.nearest_cos_[i] = Probes()[i].dot(direction) > 0.5 ? 1.0 : left.nearest_cos_[i];
    }
  }
  return words;
}

}  // namespace limbcast::sensing
