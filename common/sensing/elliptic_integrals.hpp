#pragma once

namespace limbcast::sensing {

/// The complete elliptic integral K(m), m = k², and a remainder of E(m), both with their
/// derivatives:
///
///   K = π / (2 a_N) ,   E = K (1 − m/2 − m² t) ,   t = Σ_{n≥1} 2^{n−1} (c_n/m)²
///
/// by the arithmetic-geometric mean a_0 = 1, b_0 = √(1−m), c_0² = m, c_{n+1} = c_n²/(4 a_{n+1})
/// (design/position.md section 6; Abramowitz & Stegun, 17.6). The first two terms of E are taken
/// out because K and E cancel to O(m²) in the field of a loop: t is 1/16 at m = 0 and has no
/// difference of near numbers in it.
struct EllipticIntegrals {
  double K = 0.0;
  double t = 0.0;
  double K_by_m = 0.0;
  double t_by_m = 0.0;

  [[nodiscard]] double E(double m) const { return K * (1.0 - 0.5 * m - m * m * t); }
};

/// @param m  in [0, 1).
[[nodiscard]] EllipticIntegrals EllipticIntegralsOf(double m);

}  // namespace limbcast::sensing
