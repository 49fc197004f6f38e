#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

#include "common/base/time.hpp"
#include "common/sensing/position_samples.hpp"

namespace limbcast::filters {

/// What became of an optical sample.
enum class MarkerVerdict : std::uint8_t {
  kQueued = 0,        ///< waits for the inertial reading of its time
  kFused = 1,         ///< corrected the state
  kDownweighted = 2,  ///< corrected it with less weight than it claims
  kHidden = 3,        ///< not visible or not finite: no update
  kRepeated = 4,      ///< the third and later identical one: the camera system holds its output
  kOutOfOrder = 5,    ///< not newer than the one before, or older than the filter can go back
  kOutlier = 6,       ///< rejected: far from where inertia says
  kForeign = 7,       ///< rejected: it moves like something else (ghost, swapped marker)
  kSuperseded = 8,    ///< a newer one fell into the same block
};
inline constexpr std::size_t kMarkerVerdictCount = 9;

/// One counter for each verdict.
struct MarkerCounters {
  std::array<std::uint64_t, kMarkerVerdictCount> count{};
  void Add(MarkerVerdict verdict) { ++count[static_cast<std::size_t>(verdict)]; }
  [[nodiscard]] std::uint64_t operator[](MarkerVerdict verdict) const {
    return count[static_cast<std::size_t>(verdict)];
  }
};

/// A marker position that may be used.
struct TimedMarker {
  Time at{};
  Eigen::Vector3d p_earth_marker_m = Eigen::Vector3d::Zero();
  double sigma_m = 0.0;  ///< 0 = not stated
};

/// Bad-input rules for optical samples (design/position.md section 13), and the queue in which they
/// wait for the inertial readings of their time. Thread-compatible; allocates nothing.
class MarkerGate {
 public:
  static constexpr int kRepeatsAreMissing = 3;

  /// kQueued, or why not.
  [[nodiscard]] MarkerVerdict Push(const sensing::MarkerPosition& sample);
  /// The newest queued marker with a stamp up to `until`; older ones are dropped and counted.
  [[nodiscard]] std::optional<TimedMarker> Take(Time until, MarkerCounters& counters);

 private:
  static constexpr std::size_t kQueue = 64;  // power of two; 0.2 s at 300 Hz
  std::array<TimedMarker, kQueue> queue_{};
  std::size_t head_ = 0;  // next to take
  std::size_t tail_ = 0;  // next free
  bool has_last_ = false;
  TimedMarker last_;
  int repeats_ = 1;
};

/// Watches a run of rejected samples (design/position.md section 4): at most five in a row are
/// rejected, then one is taken with less weight. A run longer than 0.2 s whose innovations do not
/// go along a line moves on its own: it belongs to something else and is kept out for up to a
/// second; after that the filter itself is in doubt. Thread-compatible.
class OutlierRun {
 public:
  static constexpr double kForeignAfter_s = 0.2;
  static constexpr double kDoubtAfter_s = 1.0;
  static constexpr double kForeignRms_m = 0.004;

  void Clear() { *this = OutlierRun(); }
  void AddRejected(Time at, const Eigen::Vector3d& nu_m);
  void AddDownweighted() { in_a_row_ = 0; }

  [[nodiscard]] int in_a_row() const { return in_a_row_; }
  [[nodiscard]] bool foreign() const;
  /// The run is too long to be somebody else's fault.
  [[nodiscard]] bool in_doubt() const { return last_s_ > kDoubtAfter_s; }
  [[nodiscard]] bool empty() const { return n_ == 0; }

 private:
  [[nodiscard]] double RmsAboutLine_m() const;

  Time begun_at_{};
  double last_s_ = 0.0;
  int n_ = 0;
  int in_a_row_ = 0;
  double sum_t_ = 0.0, sum_tt_ = 0.0, sum_nunu_ = 0.0;
  Eigen::Vector3d sum_nu_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d sum_tnu_ = Eigen::Vector3d::Zero();
};

}  // namespace limbcast::filters
