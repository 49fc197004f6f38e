#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace limbcast::sensing {

/// Which directions of the sphere a stream of readings has come near to. 240 probe directions lie
/// evenly on the sphere (Fibonacci lattice: González, "Measurement of areas on a sphere using
/// Fibonacci and latitude–longitude lattices", Math. Geosci. 42 (2010), Eq. (1)); each remembers
/// its nearest reading. Any order of readings gives the same result. Thread-compatible.
class SphereCoverage {
 public:
  static constexpr std::size_t kProbes = 240;
  /// A direction counts as covered when a reading came within this angle of it.
  static constexpr double kReach_rad = 0.5236;  // 30°

  SphereCoverage();

  /// Any length but zero; what is not finite or zero is passed over.
  void Add(const Eigen::Vector3d& direction);

  /// Share of the sphere covered, in [0, 1].
  [[nodiscard]] double share() const;
  /// Angle from the loneliest direction to its nearest reading, in [0, π]; π without readings.
  [[nodiscard]] double widest_gap_rad() const;
  /// That direction (unit).
  [[nodiscard]] Eigen::Vector3d gap_direction() const;
  /// The covered ones among the probes, in the order of Probes(), for a map.
  [[nodiscard]] std::array<bool, kProbes> covered() const;
  /// Which of +x, −x, +y, −y, +z, −z has had a reading within 30°.
  [[nodiscard]] std::array<bool, 6> faces() const;
  /// "-z, +x+y": up to three holes that lie apart, the widest first; "" when nothing is missing.
  [[nodiscard]] std::string MissingWords() const;

  [[nodiscard]] static const std::array<Eigen::Vector3d, kProbes>& Probes();

 private:
  std::array<double, kProbes> nearest_cos_{};  // of the angle to the nearest reading
  std::array<double, 6> face_cos_{};
};

}  // namespace limbcast::sensing
