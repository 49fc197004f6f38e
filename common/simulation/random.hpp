#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string_view>

namespace limbcast::simulation {

/// The seed of everything simulated where nobody gives another.
inline constexpr std::uint64_t kDefaultSeed = 20260101;

/// A stream of random numbers that is the same with every compiler and standard library (<random>
/// leaves its distributions open). xoshiro256++ 1.0, seeded by SplitMix64.
///
/// Blackman, Vigna, "Scrambled linear pseudorandom number generators", ACM TOMS 47 (2021), 36.
///
/// Thread-compatible; a copy goes on by itself with the same numbers.
class Random {
 public:
  explicit Random(std::uint64_t seed);
  /// A stream of its own for a named part, so that adding a part changes no other.
  Random(std::uint64_t seed, std::string_view part);

  [[nodiscard]] std::uint64_t Next();
  /// Even on [0, 1), 53 bits.
  [[nodiscard]] double Uniform();
  /// Even on [low, high).
  [[nodiscard]] double Uniform(double low, double high);
  /// Normal, mean 0, sigma 1 (Box & Muller 1958).
  [[nodiscard]] double Gaussian();
  [[nodiscard]] Eigen::Vector3d Gaussian3();
  /// Each axis even on [−limit, limit).
  [[nodiscard]] Eigen::Vector3d Uniform3(double limit);
  /// Even over all rotations (Shoemake, "Uniform random rotations", Graphics Gems III, 1992).
  [[nodiscard]] Eigen::Quaterniond Rotation();

 private:
  std::array<std::uint64_t, 4> state_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace limbcast::simulation
