#pragma once

#include "common/simulation/jet.hpp"

namespace limbcast::simulation {

/// From 0 (x ≤ 0) to 1 (x ≥ 1) with three continuous derivatives:
///   S(x) = 35x⁴ − 84x⁵ + 70x⁶ − 20x⁷
/// the shortest polynomial with S', S'', S''' zero at both ends.
[[nodiscard]] Jet SmoothStep(const Jet& x);

/// The same between times: 0 until `from_s`, 1 from `to_s` on (from_s < to_s).
[[nodiscard]] Jet SmoothStep(const Jet& t_s, double from_s, double to_s);

/// From 0 to 1 with two continuous derivatives: 10x³ − 15x⁴ + 6x⁵. Softer in the middle (peak speed
/// 1.88 of the mean instead of 2.19), for what a limb does in a hurry.
[[nodiscard]] Jet QuickStep(const Jet& x);

/// ∫₀ˣ S: where something is that gathers speed along S; 0 for x ≤ 0, x − ½ for x ≥ 1.
[[nodiscard]] Jet SmoothStepIntegral(const Jet& x);

/// Bump of height 1 on (0, 1) with three continuous derivatives: 256·x⁴·(1 − x)⁴.
[[nodiscard]] Jet Bump(const Jet& x);

/// Bump of height 1 on (0, 1), highest at 3/8, with two continuous derivatives: x³·(1 − x)⁵ scaled.
[[nodiscard]] Jet EarlyBump(const Jet& x);

/// 1 inside [rise_from + ramp, fall_to − ramp], 0 outside [rise_from, fall_to], smooth between.
[[nodiscard]] Jet Window(const Jet& t_s, double rise_from_s, double fall_to_s, double ramp_s);

}  // namespace limbcast::simulation
