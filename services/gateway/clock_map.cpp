#include "services/gateway/clock_map.hpp"

#include <algorithm>
#include <cmath>

#include "common/base/expects.hpp"
#include "common/base/range.hpp"

namespace limbcast::gateway {

namespace {

double Nanoseconds(Duration duration) { return static_cast<double>(duration.count()); }

}  // namespace

Status Validate(const ClockMapConfig& config) {
  return CheckRanges("clock_map.", {{"window_s", config.window_s, 1.0, 600.0},
                                    {"thin_s", config.thin_s, 0.001, 1.0},
                                    {"max_skew", config.max_skew, 1e-9, 0.1},
                                    {"jump_s", config.jump_s, 0.01, 60.0}});
}

ClockMap::ClockMap(ClockMapConfig config) : config_(config) {
  Expects(Validate(config_).ok(), "a valid ClockMapConfig");
}

double ClockMap::Line_ns(Duration device) const {
  return Nanoseconds(anchor_.delay) + skew_ * Nanoseconds(device - anchor_.device);
}

void ClockMap::Restart(const Point& point) {
  points_.clear();
  points_.push_back(point);
  hull_.assign(1, point);
  anchor_ = point;
  skew_ = 0.0;
  mapped_ = false;
}

void ClockMap::Update(Duration device, Time received_at) {
  const Point point{.device = device, .delay = received_at.time_since_epoch() - device};
  const Duration jump = DurationFromSeconds(config_.jump_s);
  if (!started()) {
    Restart(point);
    return;
  }
  // Far below the line, or far back: another clock. Far above it may only be a slow packet, unless
  // the time since the last one says that the whole window is gone.
  const bool went_back = device + jump < points_.back().device;
  const bool too_early = Nanoseconds(point.delay) < Line_ns(device) - Nanoseconds(jump);
  const bool window_gone = device - points_.back().device > DurationFromSeconds(config_.window_s);
  if (went_back || too_early || window_gone) {
    Restart(point);
    ++restarts_;
    return;
  }
  if (device <= points_.back().device) {
    return;  // an old packet tells nothing new
  }
  Add(point);
  Fit();
}

void ClockMap::Add(const Point& point) {
  const auto slot_of = [this](const Point& p) {
    return std::floor(ToSeconds(p.device) / config_.thin_s);
  };
  if (slot_of(points_.back()) == slot_of(point)) {
    if (point.delay < points_.back().delay) {
      points_.back() = point;
    }
  } else {
    points_.push_back(point);
  }
  const Duration window = DurationFromSeconds(config_.window_s);
  while (point.device - points_.front().device > window) {
    points_.pop_front();
  }
}

void ClockMap::Fit() {
  // Andrew's monotone chain, lower half; points_ is sorted by device time.
  hull_.clear();
  double centre_ns = 0.0;
  const Duration zero = points_.front().device;
  for (const Point& point : points_) {
    const auto turns_right = [&](const Point& a, const Point& b) {
      return Nanoseconds(b.device - a.device) * Nanoseconds(point.delay - a.delay) <=
             Nanoseconds(b.delay - a.delay) * Nanoseconds(point.device - a.device);
    };
    while (hull_.size() >= 2 && turns_right(hull_[hull_.size() - 2], hull_.back())) {
      hull_.pop_back();
    }
    hull_.push_back(point);
    centre_ns += Nanoseconds(point.device - zero) / static_cast<double>(points_.size());
  }
  anchor_ = hull_.back();
  skew_ = 0.0;
  for (std::size_t i = 1; i < hull_.size(); ++i) {
    const double end_ns = Nanoseconds(hull_[i].device - zero);
    if (end_ns >= centre_ns) {
      const double run_ns = Nanoseconds(hull_[i].device - hull_[i - 1].device);
      const double rise_ns = Nanoseconds(hull_[i].delay - hull_[i - 1].delay);
      anchor_ = hull_[i];
      skew_ = std::clamp(rise_ns / run_ns, -config_.max_skew, config_.max_skew);
      break;
    }
  }
}

Time ClockMap::ToHost(Duration device) {
  Expects(started(), "a clock map with at least one packet");
  const auto delay = Duration{static_cast<std::int64_t>(std::llround(Line_ns(device)))};
  Time host{device + delay};
  if (mapped_ && device >= last_device_ && host < last_host_) {
    host = last_host_;  // the line has moved: stand still rather than go back
  }
  if (!mapped_ || device >= last_device_) {
    last_device_ = device;
    last_host_ = host;
    mapped_ = true;
  }
  return host;
}

}  // namespace limbcast::gateway
