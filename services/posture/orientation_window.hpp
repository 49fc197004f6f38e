#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <optional>

#include "common/base/time.hpp"
#include "common/body/alignment.hpp"

namespace limbcast::posture {

/// The last moments of one sensor's orientation, thinned out to a fixed number, so that a reference
/// pose can be averaged at the instant the command arrives. No allocation. Thread-compatible.
class OrientationWindow {
 public:
  explicit OrientationWindow(Duration span) : span_(span) {}

  /// Times that go backwards start the window anew.
  void Add(Time measured_at, const Eigen::Quaterniond& q);

  /// Mean and spread over the last `span` before the newest; nothing while less than half of the
  /// span is covered.
  [[nodiscard]] std::optional<body::OrientationAverage> Average() const;

  void Clear() { count_ = 0; }

 private:
  static constexpr std::size_t kCapacity = 24;

  Duration span_;
  std::array<Time, kCapacity> at_{};
  std::array<Eigen::Quaternionf, kCapacity> q_;  // 1e-7 rad is enough, and there are many
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

}  // namespace limbcast::posture
