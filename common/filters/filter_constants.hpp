#pragma once

namespace limbcast::filters {

/// Numbers that the filters share; sources in design/orientation.md sections 5 and 6.

/// Gravity as the published parameters assume it.
inline constexpr double kGravity_m_s2 = 9.81;

/// Below this the accelerometer says nothing about the vertical (free fall): 0.05 g.
inline constexpr double kMinSpecificForce_m_s2 = 0.05 * kGravity_m_s2;

/// A longer absence of the gyro is not bridged with its last value.
inline constexpr double kMaxGyroHold_s = 0.05;

/// A step longer than this many nominal steps is a gap; beyond kMaxBridgedGap_s the attitude is
/// started again.
inline constexpr double kGapFactor = 10.0;
inline constexpr double kMaxBridgedGap_s = 0.5;

/// How fast a limb turns while nobody looks: inflates the attitude covariance over gaps.
inline constexpr double kUnseenRate_rad_s = 0.5;

/// Without a usable magnetometer for longer, heading no longer counts as magnetic.
inline constexpr double kMagneticMemory_s = 10.0;

/// Values no body-worn sensor can read: treated like non-finite ones.
inline constexpr double kMaxPlausibleRate_rad_s = 150.0;   // 8600 °/s
inline constexpr double kMaxPlausibleForce_m_s2 = 4000.0;  // 400 g
inline constexpr double kMaxPlausibleField_tesla = 0.05;   // a thousand earth fields

}  // namespace limbcast::filters
