#pragma once

#include <Eigen/Geometry>
#include <cstdint>

namespace limbcast::tool {

/// Errors of one orientation as the BROAD benchmark defines them (D. Laidig et al., Data 2021,
/// 6(7), 72), from e = q_est ⊗ q_ref* in the earth frame: total 2·acos|w|, heading 2·atan|z/w|,
/// inclination 2·acos √(w² + z²).
struct OrientationError {
  double total_rad = 0.0;
  double heading_rad = 0.0;
  double inclination_rad = 0.0;
};

[[nodiscard]] OrientationError ErrorBetween(const Eigen::Quaterniond& q_estimate,
                                            const Eigen::Quaterniond& q_reference);

/// Root mean square and largest total error of what was added, in degrees. Thread-compatible.
class ErrorStatistics {
 public:
  void Add(const OrientationError& error);
  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] double total_rms_deg() const;
  [[nodiscard]] double heading_rms_deg() const;
  [[nodiscard]] double inclination_rms_deg() const;
  [[nodiscard]] double total_max_deg() const;

 private:
  [[nodiscard]] double Rms_deg(double sum_rad2) const;
  std::uint64_t count_ = 0;
  double total_rad2_ = 0.0;
  double heading_rad2_ = 0.0;
  double inclination_rad2_ = 0.0;
  double total_max_rad_ = 0.0;
};

}  // namespace limbcast::tool
