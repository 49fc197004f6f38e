#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "common/filters/sample_gate.hpp"

namespace limbcast::filters {

/// What has become of an attitude that the watchdog looks at.
enum class AttitudeLoss : std::uint8_t { kNone, kTilt, kHeading };

/// What AttitudeWatchdog remembers; copied as bytes when a filter saves its state.
struct AttitudeWatchdogState {
  Eigen::Vector3d low_free_m_s2 = Eigen::Vector3d::Zero();  // mean free acceleration in E
  Eigen::Vector3d free_sum_m_s2 = Eigen::Vector3d::Zero();  // since the last look
  Eigen::Vector2d low_north = Eigen::Vector2d::UnitY();     // mean field direction in E, clean only
  double pending_s = 0.0;                                   // since the last look
  double tilted_s = 0.0;
  double clean_s = 0.0;
  std::uint32_t free_count = 0;  // of free_sum_m_s2
};

/// Notices an attitude that is lost, so that a filter that has come to believe in nonsense
/// (readings stuck for seconds, garbage, a rate beyond the range) starts again instead of staying
/// wrong for good. It needs no filter's covariance:
///
/// - tilt: a worn sensor stays in a bounded region, so the mean specific force over some seconds is
///   gravity: with a right attitude, the mean free acceleration is zero. 0.35 g for 4 s is lost.
/// - heading: a field that has had the reference's norm and dip for 12 s is the earth's; when it
/// has
///   pointed elsewhere than north by more than 15° in the mean of that time, heading is lost. A
///   disturbed field never accuses.
///
/// A healthy filter is an order of magnitude away from either. Free accelerations of all samples
/// count (20 a second would alias fast shaking), fields of 20 a second. Thread-compatible.
class AttitudeWatchdog {
 public:
  /// Takes the free acceleration of a sample; true when it is time to Look.
  ///
  /// @param sample           of which only usable channels are looked at.
  /// @param free_accel_m_s2  its acceleration in E with gravity removed by the attitude after it.
  [[nodiscard]] bool Add(const GatedSample& sample, const Eigen::Vector3d& free_accel_m_s2) {
    state_.pending_s += sample.dt_s;
    // Number by number: they were stored so a moment ago, and pairs would wait for the stores.
    const double x = free_accel_m_s2[0];
    const double y = free_accel_m_s2[1];
    const double z = free_accel_m_s2[2];
    if (sample.accel_valid && x * x + y * y + z * z < kMostFree_m_s2 * kMostFree_m_s2) {
      state_.free_sum_m_s2[0] += x;
      state_.free_sum_m_s2[1] += y;
      state_.free_sum_m_s2[2] += z;
      ++state_.free_count;
    }
    return state_.pending_s >= kLookEvery_s;
  }

  /// @param sample           the one that was added last.
  /// @param q_earth_sensor   the attitude after that sample, unit.
  /// @param reference_ref    earth field at start (0, north, up), unit length; zero: none known.
  /// @param per_tesla        1 / its norm in tesla.
  [[nodiscard]] AttitudeLoss Look(const GatedSample& sample,
                                  const Eigen::Quaterniond& q_earth_sensor,
                                  const Eigen::Vector3d& reference_ref, double per_tesla);

  /// The attitude was started again.
  void Clear() { state_ = {}; }

  [[nodiscard]] const AttitudeWatchdogState& state() const { return state_; }

 private:
  static constexpr double kLookEvery_s = 0.05;
  static constexpr double kMostFree_m_s2 = 200.0;  // more is an impact or nonsense

  [[nodiscard]] bool TiltLost(double T);
  [[nodiscard]] bool HeadingLost(const Eigen::Vector3d& field_E_ref,
                                 const Eigen::Vector3d& reference_ref, double T);

  AttitudeWatchdogState state_;
};

}  // namespace limbcast::filters
