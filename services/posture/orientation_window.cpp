#include "services/posture/orientation_window.hpp"

#include <algorithm>
#include <span>

namespace limbcast::posture {

void OrientationWindow::Add(Time measured_at, const Eigen::Quaterniond& q) {
  // A little closer than span / capacity, so that the ring always covers the span.
  const Duration spacing = span_ / (kCapacity - 4);
  if (count_ > 0) {
    const Time last = at_[(next_ + kCapacity - 1) % kCapacity];
    if (measured_at < last) {
      Clear();
    } else if (measured_at - last < spacing) {
      return;
    }
  }
  at_[next_] = measured_at;
  q_[next_] = q.cast<float>();
  next_ = (next_ + 1) % kCapacity;
  count_ = std::min(count_ + 1, kCapacity);
}

std::optional<body::OrientationAverage> OrientationWindow::Average() const {
  if (count_ == 0) {
    return std::nullopt;
  }
  const Time newest = at_[(next_ + kCapacity - 1) % kCapacity];
  Time oldest = newest;
  std::array<Eigen::Quaterniond, kCapacity> within;
  std::size_t taken = 0;
  for (std::size_t back = 1; back <= count_; ++back) {
    const std::size_t i = (next_ + kCapacity - back) % kCapacity;
    if (newest - at_[i] > span_) {
      break;
    }
    oldest = at_[i];
    within[taken++] = q_[i].cast<double>();
  }
  if (newest - oldest < span_ / 2) {
    return std::nullopt;
  }
  return body::Average(std::span(within.data(), taken));
}

}  // namespace limbcast::posture
