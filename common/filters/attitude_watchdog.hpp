#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "common/filters/sample_gate.hpp"

namespace limbcast::filters {

/// What has become of an attitude that the watchdog looks at.
enum class AttitudeLoss : std::uint8_t { kNone, kTilt, kHeading };

/// What AttitudeWatchdog remembers; copied as bytes when a filter saves its state.
struct AttitudeWatchdogState {
  Eigen::Vector3d low_force_g = Eigen::Vector3d::UnitZ();  // mean specific force in E
  Eigen::Vector2d low_north = Eigen::Vector2d::UnitY();    // mean field direction in E, clean only
  double pending_s = 0.0;                                  // since the last look
  double tilted_s = 0.0;
  double clean_s = 0.0;
};

/// Notices an attitude that is lost, so that a filter that has come to believe in nonsense
/// (readings stuck for seconds, garbage, a rate beyond the range) starts again instead of staying
/// wrong for good. It needs no filter's covariance:
///
/// - tilt: a worn sensor stays in a bounded region, so the mean specific force over some seconds is
///   gravity. Turned to the earth frame by a right attitude it is (0, 0, 1) g; 0.35 g away from
///   that for 4 s is lost.
/// - heading: a field that has had the reference's norm and dip for 12 s is the earth's; when it
/// has
///   pointed elsewhere than north by more than 15° in the mean of that time, heading is lost. A
///   disturbed field never accuses.
///
/// A healthy filter is an order of magnitude away from either. Looks at 20 samples a second.
/// Thread-compatible.
class AttitudeWatchdog {
 public:
  /// @param sample           of which only usable channels are looked at.
  /// @param q_earth_sensor   the attitude after that sample, unit.
  /// @param reference_ref    earth field at start (0, north, up), unit length; zero: none known.
  /// @param per_tesla        1 / its norm in tesla.
  [[nodiscard]] AttitudeLoss Update(const GatedSample& sample,
                                    const Eigen::Quaterniond& q_earth_sensor,
                                    const Eigen::Vector3d& reference_ref, double per_tesla) {
    state_.pending_s += sample.dt_s;
    return state_.pending_s < kLookEvery_s ? AttitudeLoss::kNone
                                           : Look(sample, q_earth_sensor, reference_ref, per_tesla);
  }

  /// The attitude was started again.
  void Clear() { state_ = {}; }

  [[nodiscard]] const AttitudeWatchdogState& state() const { return state_; }

 private:
  static constexpr double kLookEvery_s = 0.05;

  AttitudeLoss Look(const GatedSample& sample, const Eigen::Quaterniond& q_earth_sensor,
                    const Eigen::Vector3d& reference_ref, double per_tesla);
  [[nodiscard]] bool TiltLost(const Eigen::Vector3d& force_E_g, double T);
  [[nodiscard]] bool HeadingLost(const Eigen::Vector3d& field_E_ref,
                                 const Eigen::Vector3d& reference_ref, double T);

  AttitudeWatchdogState state_;
};

}  // namespace limbcast::filters
