#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "common/body/segment_state.hpp"
#include "common/sensing/marg_sample.hpp"
#include "common/sensing/position_samples.hpp"
#include "services/fusion/coil_track.hpp"
#include "services/fusion/marker_track.hpp"
#include "services/fusion/position_config.hpp"
#include "services/fusion/router.hpp"

namespace limbcast::fusion {

/// The positions of one body's sensors: a coil track or a marker track for each segment that the
/// configuration names and the body wears. Filters are made with the plan, so that neither the
/// first pulse nor the first marker allocates. Thread-compatible; allocates in Apply only.
class BodyPositions {
 public:
  /// `config` is valid and outlives it.
  explicit BodyPositions(const PositionConfig& config) : config_(config) {
    lagged_.filter.reserve(16);  // bound of the wire type: no allocation later
  }

  /// Tracks of sensors that stay where they are go on.
  void Apply(const BodyPlan& plan);

  void OnMarker(const sensing::MarkerPosition& marker);

  /// After the sensor's orientation filter had `sample` and filled `state` (slot 0): fills in the
  /// position, or that there is none. A segment with both has the marker's position.
  void Update(const sensing::MargSample& sample, body::SegmentState& state);

  /// What the sensor's last Update made known of an earlier time: a state of slot 2, or null. `now`
  /// is the state that Update filled. Its orientation is that of the position filter; rates and
  /// acceleration are not known. Apart, because it takes longer than the position itself.
  [[nodiscard]] body::SegmentState* Lagged(const body::SegmentState& now);

  [[nodiscard]] bool empty() const { return coils_.empty() && markers_.empty(); }

 private:
  struct Coil {
    SensorUid sensor_uid;
    std::unique_ptr<CoilTrack> track;
  };
  struct Marker {
    SensorUid sensor_uid;
    body::Segment segment;
    std::unique_ptr<MarkerTrack> track;
  };
  struct Source {
    explicit Source(SensorUid uid) : sensor_uid(uid) {}
    SensorUid sensor_uid;
    std::optional<sensing::MargSample> sample;
    Eigen::Quaterniond q_earth_sensor = Eigen::Quaterniond::Identity();
    bool started = false;
  };

  [[nodiscard]] std::optional<SegmentPosition> Track(const sensing::MargSample& sample,
                                                     body::SegmentState& state);
  void FillLagged(const LaggedPosition& from, std::string_view filter,
                  const body::SegmentState& now);

  const PositionConfig& config_;
  std::optional<Source> source_;
  std::vector<Coil> coils_;
  std::vector<Marker> markers_;
  body::SegmentState lagged_;
};

}  // namespace limbcast::fusion
