#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <vector>

#include "common/filters/position/coil_both_sides.hpp"
#include "common/filters/position/coil_smoothing.hpp"
#include "common/sensing/marg_sample.hpp"
#include "services/fusion/position_config.hpp"
#include "services/fusion/segment_position.hpp"

namespace limbcast::fusion {

/// Position of one sensor relative to the sensor that carries the coils: the magnetic + inertial
/// filter on the raw samples of both, with what the samples' flags say of the source. Allocates
/// nothing after construction. Thread-compatible.
class CoilTrack {
 public:
  /// The source's newest sample may be this much older or newer than the sensor's.
  static constexpr double kMostApart_s = 0.025;

  /// The smoothed position is for samples that do not come faster.
  static constexpr double kHighestLagRate_hz = 200.0;

  /// @param config  valid.
  /// @param lag_s   of the smoothed position; 0 = none.
  explicit CoilTrack(const CoilAidConfig& config, double lag_s = 0.0);

  /// @param source          the newest sample of the source's sensor.
  /// @param q_earth_source  of that sensor by its orientation filter: the axes in which the result
  ///                        is given, so that turning it back with the same orientation gives the
  ///                        position in the coils' axes.
  /// @returns nothing while the track is lost, or the side of the source is not known.
  [[nodiscard]] std::optional<SegmentPosition> Update(const sensing::MargSample& sample,
                                                      const sensing::MargSample& source,
                                                      const Eigen::Quaterniond& q_earth_source);

  /// What the last Update made known of an earlier time, if anything. Apart, because it takes
  /// longer than the position itself; once after each Update.
  [[nodiscard]] std::optional<LaggedPosition> Lagged();

  [[nodiscard]] const filters::CoilBothSides& filter() const { return filter_; }

 private:
  // The axes of results at one time.
  struct Axes {
    Time at{};
    Eigen::Quaterniond q_earth_source = Eigen::Quaterniond::Identity();
  };
  struct Lag {
    explicit Lag(double lag_s);
    filters::CoilFixedLag smoother;
    std::vector<Axes> axes;  // ring
    std::size_t newest = 0;
    bool pending = false;  // an Update that was not looked at
  };

  double current_a_;
  filters::CoilBothSides filter_;
  std::optional<Lag> lag_;
};

}  // namespace limbcast::fusion
