#include "common/simulation/random.hpp"

#include <cmath>
#include <numbers>

#include "common/base/fnv1a.hpp"

namespace limbcast::simulation {
namespace {

std::uint64_t SplitMix(std::uint64_t& state) {
  state += 0x9E3779B97F4A7C15U;
  std::uint64_t z = state;
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31U);
}

// FNV-1a over the seed's and the name's bytes.
std::uint64_t SeedOf(std::uint64_t seed, std::string_view part) {
  return Fnv1a(kFnv1aBasis ^ seed, part);
}

constexpr std::uint64_t RotateLeft(std::uint64_t x, unsigned by) {
  return (x << by) | (x >> (64U - by));
}

}  // namespace

Random::Random(std::uint64_t seed) : state_{} {
  for (std::uint64_t& word : state_) {
    word = SplitMix(seed);
  }
}

Random::Random(std::uint64_t seed, std::string_view part) : Random(SeedOf(seed, part)) {}

std::uint64_t Random::Next() {
  auto& s = state_;
  const std::uint64_t result = RotateLeft(s[0] + s[3], 23) + s[0];
  const std::uint64_t t = s[1] << 17U;
  s[2] ^= s[0];
  s[3] ^= s[1];
  s[1] ^= s[2];
  s[0] ^= s[3];
  s[2] ^= t;
  s[3] = RotateLeft(s[3], 45);
  return result;
}

double Random::Uniform() { return static_cast<double>(Next() >> 11U) * 0x1.0p-53; }

double Random::Uniform(double low, double high) { return low + (high - low) * Uniform(); }

double Random::Gaussian() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const double radius = std::sqrt(-2.0 * std::log(1.0 - Uniform()));  // 1 − u is never 0
  const double angle = 2.0 * std::numbers::pi * Uniform();
  spare_ = radius * std::sin(angle);
  has_spare_ = true;
  return radius * std::cos(angle);
}

Eigen::Vector3d Random::Gaussian3() {
  const double x = Gaussian();
  const double y = Gaussian();
  return {x, y, Gaussian()};
}

Eigen::Vector3d Random::Uniform3(double limit) {
  const double x = Uniform(-limit, limit);
  const double y = Uniform(-limit, limit);
  return {x, y, Uniform(-limit, limit)};
}

Eigen::Quaterniond Random::Rotation() {
  const double u = Uniform();
  const double a = 2.0 * std::numbers::pi * Uniform();
  const double b = 2.0 * std::numbers::pi * Uniform();
  const double r1 = std::sqrt(1.0 - u);
  const double r2 = std::sqrt(u);
  return {r2 * std::cos(b), r1 * std::sin(a), r1 * std::cos(a), r2 * std::sin(b)};
}

}  // namespace limbcast::simulation
