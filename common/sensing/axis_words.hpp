#pragma once

#include <Eigen/Core>
#include <string>

namespace limbcast::sensing {

/// A direction in sensor axes in words that a person can follow: the axes that have a part of at
/// least 0.4 in it, e.g. "+x", "-y+z". `direction` has any length but zero.
[[nodiscard]] std::string DirectionWords(const Eigen::Vector3d& direction);

/// "12.5" with that many decimals, for messages; the same in every locale.
[[nodiscard]] std::string NumberText(double value, int decimals);

/// 0.734 → "73 %".
[[nodiscard]] std::string PercentText(double share, int decimals = 0);

}  // namespace limbcast::sensing
