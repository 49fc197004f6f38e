#include "common/simulation/smooth_step.hpp"

namespace limbcast::simulation {

Jet SmoothStep(const Jet& x) {
  const double v = x.value;
  if (v <= 0.0) {
    return {};
  }
  if (v >= 1.0) {
    return {1.0};
  }
  const double v2 = v * v;
  const double u = 1.0 - v;
  return Chain(x, v2 * v2 * (35.0 + v * (-84.0 + v * (70.0 - 20.0 * v))),
               140.0 * v2 * v * u * u * u, 420.0 * v2 * u * u * (1.0 - 2.0 * v));
}

Jet SmoothStep(const Jet& t_s, double from_s, double to_s) {
  return SmoothStep((t_s - from_s) * (1.0 / (to_s - from_s)));
}

Jet QuickStep(const Jet& x) {
  const double v = x.value;
  if (v <= 0.0) {
    return {};
  }
  if (v >= 1.0) {
    return {1.0};
  }
  const double u = 1.0 - v;
  return Chain(x, v * v * v * (10.0 + v * (-15.0 + 6.0 * v)), 30.0 * v * v * u * u,
               60.0 * v * u * (1.0 - 2.0 * v));
}

Jet SmoothStepIntegral(const Jet& x) {
  const double v = x.value;
  if (v <= 0.0) {
    return {};
  }
  if (v >= 1.0) {
    return x - 0.5;
  }
  const Jet step = SmoothStep(Jet::Variable(v));
  const double v4 = v * v * v * v;
  return Chain(x, v4 * v * (7.0 + v * (-14.0 + v * (10.0 - 2.5 * v))), step.value, step.rate);
}

Jet Bump(const Jet& x) {
  const double v = x.value;
  if (v <= 0.0 || v >= 1.0) {
    return {};
  }
  const double a = v * (1.0 - v);  // 256·a⁴ with a' = 1 − 2v, a'' = −2
  const double da = 1.0 - 2.0 * v;
  const double a2 = a * a;
  return Chain(x, 256.0 * a2 * a2, 1024.0 * a2 * a * da,
               1024.0 * (3.0 * a2 * da * da - 2.0 * a2 * a));
}

Jet EarlyBump(const Jet& x) {
  const double v = x.value;
  if (v <= 0.0 || v >= 1.0) {
    return {};
  }
  constexpr double kPeak = 3.0 * 3.0 * 3.0 * 5.0 * 5.0 * 5.0 * 5.0 * 5.0 / 16777216.0;  // at 3/8
  const double u = 1.0 - v;
  const double u3 = u * u * u / kPeak;
  return Chain(x, v * v * v * u * u * u3, v * v * u * u3 * (3.0 - 8.0 * v),
               v * u3 * (6.0 - 42.0 * v + 56.0 * v * v));
}

Jet Window(const Jet& t_s, double rise_from_s, double fall_to_s, double ramp_s) {
  return SmoothStep(t_s, rise_from_s, rise_from_s + ramp_s) -
         SmoothStep(t_s, fall_to_s - ramp_s, fall_to_s);
}

}  // namespace limbcast::simulation
