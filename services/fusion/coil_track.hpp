#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "common/filters/position/coil_both_sides.hpp"
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

  /// @param config  valid.
  explicit CoilTrack(const CoilAidConfig& config);

  /// @param source          the newest sample of the source's sensor.
  /// @param q_earth_source  of that sensor by its orientation filter: the axes in which the result
  ///                        is given, so that turning it back with the same orientation gives the
  ///                        position in the coils' axes.
  /// @returns nothing while the track is lost, or the side of the source is not known.
  [[nodiscard]] std::optional<SegmentPosition> Update(const sensing::MargSample& sample,
                                                      const sensing::MargSample& source,
                                                      const Eigen::Quaterniond& q_earth_source);

  [[nodiscard]] const filters::CoilBothSides& filter() const { return filter_; }

 private:
  double current_a_;
  filters::CoilBothSides filter_;
};

}  // namespace limbcast::fusion
