#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "common/filters/position/fixed_lag_position.hpp"
#include "common/filters/position/optical_inertial_filter.hpp"
#include "common/sensing/marg_sample.hpp"
#include "common/sensing/position_samples.hpp"
#include "services/fusion/segment_position.hpp"

namespace limbcast::fusion {

/// Position of one sensor that carries a marker: the inertial + optical filter, started from the
/// attitude of the orientation filter, so that it starts in the middle of a walk. Works in the
/// optical system's frame, which is taken for the earth frame. Allocates nothing after
/// construction. Thread-compatible.
class MarkerTrack {
 public:
  /// A position less certain than this (1 σ, 3-D) is none: the marker has been hidden for long.
  static constexpr double kLeastCertain_m = 0.5;

  /// @param config  valid.
  /// @param lag_s   of the smoothed position; 0 = none.
  explicit MarkerTrack(const filters::OpticalInertialConfig& config, double lag_s = 0.0);

  void OnMarker(const sensing::MarkerPosition& marker) {
    static_cast<void>(filter_.AddMarker(marker));
  }

  /// @param q_earth_sensor  of the orientation filter after this sample; nothing while it has none.
  /// @returns nothing while there is no position.
  [[nodiscard]] std::optional<SegmentPosition> Update(
      const sensing::MargSample& sample, const std::optional<Eigen::Quaterniond>& q_earth_sensor);

  /// What the last Update made known of an earlier time, if anything; see CoilTrack.
  [[nodiscard]] std::optional<LaggedPosition> Lagged();

  [[nodiscard]] const filters::OpticalInertialFilter& filter() const { return filter_; }

 private:
  filters::OpticalInertialFilter filter_;
  std::optional<filters::FixedLagPosition> lag_;
  bool pending_ = false;  // a closed epoch that was not looked at
};

}  // namespace limbcast::fusion
