#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "common/base/result.hpp"
#include "common/base/time.hpp"

namespace limbcast::gateway {

/// Tuning of ClockMap.
struct ClockMapConfig {
  /// Span of the packets that the line is laid through. Longer follows the skew more exactly,
  /// shorter follows a device whose rate changes. Range: [1, 600].
  double window_s = 30.0;

  /// Packets are thinned to one in this span (the quickest one). Range: [0.001, 1].
  double thin_s = 0.1;

  /// Skews beyond this are not believed; crystals are better than 0.5 %. Range: (0, 0.1].
  double max_skew = 0.01;

  /// A device time that goes back by more than this, or a packet that is off the line by more than
  /// this, means that the device's clock was set: begin anew. Range: [0.01, 60].
  double jump_s = 1.0;
};

[[nodiscard]] Status Validate(const ClockMapConfig& config);

/// Maps a device's clock to the host's from pairs (device time, time of arrival). A packet arrives
/// late by transport, never early, so the truth is the line under the points: host = device +
/// offset
/// + skew·(device − newest), the lower edge of their convex hull, taken where the middle of the
/// window is. Delays and their jitter, however large, then do not move the result as long as now
/// and then a packet comes quickly; what is left in it is the smallest delay.
///
///   the lower hull and its edge over the centroid: L. Zhang, Z. Liu, C. H. Xia, "Clock
///   synchronization algorithms for network measurements", IEEE INFOCOM 2002, section III
///
/// The mapped times are monotonic where the device's are. Thread-compatible; takes the times as
/// arguments and reads no clock.
class ClockMap {
 public:
  /// `config` is valid.
  explicit ClockMap(ClockMapConfig config = {});

  /// Takes the pair of one packet. `device` is on the device's own scale (any zero).
  void Update(Duration device, Time received_at);

  /// Host time of `device`. Only after the first Update.
  [[nodiscard]] Time ToHost(Duration device);

  [[nodiscard]] bool started() const { return !hull_.empty(); }
  /// Seconds that the host gains on the device in each second of the device.
  [[nodiscard]] double skew() const { return skew_; }
  /// How often the map began anew after a jump.
  [[nodiscard]] std::size_t restarts() const { return restarts_; }

 private:
  struct Point {
    Duration device;
    Duration delay;  // received − device, on the scale of the host
  };
  void Restart(const Point& point);
  void Add(const Point& point);
  void Fit();
  [[nodiscard]] double Line_ns(Duration device) const;

  ClockMapConfig config_;
  std::deque<Point> points_;  // thinned, in the order of device time
  std::vector<Point> hull_;   // lower convex hull of points_
  Point anchor_{};            // the line goes through it
  double skew_ = 0.0;
  std::size_t restarts_ = 0;
  Duration last_device_{};
  Time last_host_{};
  bool mapped_ = false;
};

}  // namespace limbcast::gateway
