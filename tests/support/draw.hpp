#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <random>
#include <string>

#include "common/base/time.hpp"
#include "common/body/segment.hpp"

namespace limbcast::test_support {

/// Draws fields one after the other; the same key and sequence give the same fields.
class Draw {
 public:
  Draw(std::uint32_t key, std::uint32_t sequence)
      : rng_(key * 1'000'003ULL + sequence * 7919ULL + 1) {}
  std::uint32_t Below(std::uint32_t limit) { return static_cast<std::uint32_t>(rng_() % limit); }
  bool Coin() { return Below(2) == 1; }
  std::uint64_t Bits() { return rng_(); }
  double Real() {
    return static_cast<double>(static_cast<std::int64_t>(rng_() >> 20U)) * 1e-6 - 8e6;
  }
  float Single() { return static_cast<float>(Below(2'000'001)) * 1e-4F - 100.0F; }
  Time Instant() { return TimeFromNanoseconds(1'700'000'000'000'000'000 + Below(1'000'000'000)); }
  Eigen::Vector3f Vector3f() { return {Single(), Single(), Single()}; }
  Eigen::Vector3d Vector3d() { return {Real(), Real(), Real()}; }
  Eigen::Matrix3f Matrix3f() {
    Eigen::Matrix3f m;
    m << Vector3f(), Vector3f(), Vector3f();
    return m;
  }
  Eigen::Matrix3d Matrix3d() {
    Eigen::Matrix3d m;
    m << Vector3d(), Vector3d(), Vector3d();
    return m;
  }
  Eigen::Quaterniond Rotation() {
    return Eigen::Quaterniond(1.0 + Below(100), Below(100), Below(100), Below(100)).normalized();
  }
  std::string Text(std::uint32_t longest) {
    std::string text(Below(longest + 1), '?');
    for (char& c : text) {
      c = static_cast<char>('a' + Below(26));
    }
    return text;
  }
  template <typename E>
  E OneOf(std::uint32_t count) {
    return static_cast<E>(Below(count));
  }
  body::Segment Segment() { return OneOf<body::Segment>(body::kSegmentCount); }

 private:
  std::mt19937_64 rng_;
};

}  // namespace limbcast::test_support
