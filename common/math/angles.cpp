#include "common/math/angles.hpp"

#include <cmath>
#include <numbers>

namespace limbcast::math {

double WrappedAngle_rad(double angle_rad) {
  return std::remainder(angle_rad, 2.0 * std::numbers::pi);
}

void AngleMean::Add(double angle_rad, double weight) {
  cos_ += weight * std::cos(angle_rad);
  sin_ += weight * std::sin(angle_rad);
}

double AngleMean::Mean_rad() const { return std::atan2(sin_, cos_); }

double AngleMean::length() const { return std::hypot(cos_, sin_); }

}  // namespace limbcast::math
