#include "common/sensing/elliptic_integrals.hpp"

#include <cmath>
#include <numbers>

namespace limbcast::sensing {

EllipticIntegrals EllipticIntegralsOf(double m) {
  constexpr int kMaxSteps = 12;    // doubles the digits each time; m = 1 − 1e-16 needs eight
  constexpr double kDone = 1e-17;  // of t, which is 1/16 or more
  const double root = std::sqrt(1.0 - m);
  double a = 0.5 * (1.0 + root);
  double b = std::sqrt(root);
  double e = 0.5 / (1.0 + root);  // c_n / m; c_1 = (1 − √(1−m))/2
  // Derivatives by m beside them.
  const double root_by_m = -0.5 / root;
  double a_by_m = 0.5 * root_by_m;
  double b_by_m = 0.5 * root_by_m / b;
  double e_by_m = -2.0 * e * e * root_by_m;

  EllipticIntegrals result;
  double weight = 1.0;  // 2^{n−1}
  for (int n = 1; n <= kMaxSteps; ++n) {
    result.t += weight * e * e;
    result.t_by_m += weight * 2.0 * e * e_by_m;
    const double a_next = 0.5 * (a + b);
    const double a_next_by_m = 0.5 * (a_by_m + b_by_m);
    const double e_next = m * e * e / (4.0 * a_next);
    e_by_m = (e * e + 2.0 * m * e * e_by_m) / (4.0 * a_next) - e_next * a_next_by_m / a_next;
    const double b_next = std::sqrt(a * b);
    b_by_m = 0.5 * (a_by_m * b + a * b_by_m) / b_next;
    a = a_next;
    a_by_m = a_next_by_m;
    b = b_next;
    e = e_next;
    weight *= 2.0;
    if (weight * (e * e + std::abs(e * e_by_m)) < kDone) {
      break;
    }
  }
  result.K = 0.5 * std::numbers::pi / a;
  result.K_by_m = -result.K * a_by_m / a;
  return result;
}

}  // namespace limbcast::sensing
