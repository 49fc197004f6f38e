#pragma once

namespace limbcast::math {

/// The same angle in [−π, π].
[[nodiscard]] double WrappedAngle_rad(double angle_rad);

/// Mean of angles on the circle: the direction of the sum of their unit vectors.
///
/// Mardia, Jupp, "Directional Statistics", 2000, section 2.2.1. Thread-compatible.
class AngleMean {
 public:
  void Add(double angle_rad, double weight = 1.0);

  /// In [−π, π]; 0 when nothing was added.
  [[nodiscard]] double Mean_rad() const;
  /// Length of the sum: zero when nothing was added, or when it says no direction.
  [[nodiscard]] double length() const;

 private:
  double cos_ = 0.0;
  double sin_ = 0.0;
};

}  // namespace limbcast::math
