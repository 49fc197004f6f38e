#pragma once

#include <cstddef>
#include <vector>

#include "common/base/time.hpp"
#include "common/filters/position/coil_inertial_filter.hpp"
#include "common/filters/position/lag_window.hpp"

namespace limbcast::filters {

/// Pose of a sensor relative to its source at one instant.
struct CoilEstimate {
  Time measured_at{};
  bool valid = false;  ///< false: not tracking; the rest is dead reckoning
  Eigen::Vector3d p_emitter_sensor_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_earth_m = Eigen::Vector3d::Zero();  ///< the same in the earth frame
  /// Of the sensor against the source as seen from the earth, in the source's axes.
  Eigen::Vector3d v_emitter_sensor_m_s = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_sensor_emitter = Eigen::Quaterniond::Identity();
  double sigma_m = 0.0;    ///< √ of the trace of the position's covariance
  double sigma_rad = 0.0;  ///< the same of the relative orientation
};

/// The estimate of a state with its covariance.
[[nodiscard]] CoilEstimate EstimateOf(const CoilInertialState& state, const CoilCovariance& P,
                                      Time measured_at, bool valid);

/// Estimates that wait `lag` for what comes after them (design/position.md sections 5 and 10).
/// Allocates at construction only. Thread-compatible.
class CoilFixedLag {
 public:
  /// @param lag_s    > 0.
  /// @param rate_hz  highest rate of frames.
  CoilFixedLag(double lag_s, double rate_hz);

  /// Takes what the filter is at after a frame. Returns the estimate of the newest frame that is at
  /// least `lag_s` old; false as long as there is none. Sigmas are those of the forward filter.
  bool Update(const CoilInertialFilter& filter, Time measured_at, CoilEstimate& lagged);

  /// Forgets what it has: the next frame is of another track.
  void Clear() {
    window_.Clear();
    count_ = 0;
  }

 private:
  static constexpr int kOutputs = 12;  // p, v and both attitudes: the first elements of the state
  struct Epoch {
    Time measured_at{};
    CoilInertialState state;
    double sigma_m = 0.0;
    double sigma_rad = 0.0;
    bool valid = false;
    std::size_t records = 0;
  };

  double lag_s_;
  LagWindow<CoilInertialIndex::kAll, CoilInertialIndex::kMixing, 3, kOutputs> window_;
  std::vector<Epoch> epochs_;  // ring
  std::size_t newest_ = 0;
  std::size_t count_ = 0;
};

/// A whole recording smoothed from its end: keeps about 25 kB for each frame.
class CoilIntervalSmoother {
 public:
  void Add(const CoilInertialFilter& filter, Time measured_at);
  /// Estimates of all frames added, with their sigmas.
  [[nodiscard]] std::vector<CoilEstimate> Smooth() const;

 private:
  struct Epoch {
    Time measured_at{};
    bool valid = false;
    CoilInertialState state;
    CoilCovariance P;
    std::vector<CoilRecord> records;
  };
  std::vector<Epoch> epochs_;
};

}  // namespace limbcast::filters
