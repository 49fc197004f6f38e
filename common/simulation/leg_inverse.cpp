#include "common/simulation/leg_inverse.hpp"

#include "common/simulation/smooth_step.hpp"

namespace limbcast::simulation {

Jet KneeFlexion(const Jet& hip_to_ankle_m, double upper_m, double lower_m) {
  constexpr double kFree = 0.997;   // of the leg's length: below this the clamp is the identity
  constexpr double kBand = 0.0048;  // the clamp ends at kFree + kBand/2 = 0.9994
  const double length_m = upper_m + lower_m;
  const double band_m = kBand * length_m;
  const Jet over = (hip_to_ankle_m - kFree * length_m) * (1.0 / band_m);
  const Jet d_m = hip_to_ankle_m - band_m * SmoothStepIntegral(over);
  const Jet cosine =
      (d_m * d_m - (upper_m * upper_m + lower_m * lower_m)) * (1.0 / (2.0 * upper_m * lower_m));
  return Acos(cosine);
}

Jet HipToAnkle(const Jet& knee_flexion_rad, double upper_m, double lower_m) {
  return Sqrt(upper_m * upper_m + lower_m * lower_m +
              (2.0 * upper_m * lower_m) * Cos(knee_flexion_rad));
}

LegAxes SolveLeg(const Jet3& hip_to_ankle, const Jet3& forward, const Jet& knee_flexion_rad,
                 double upper_m, double lower_m) {
  const Jet3& e = hip_to_ankle;
  LegAxes leg;
  leg.knee_flexion_rad = knee_flexion_rad;
  leg.hinge = Normalized(Cross(forward, e));
  const Jet3 front = Cross(e, leg.hinge);
  // The upper bone leads the line hip→ankle by `lead`, the lower one trails it by the rest.
  const Jet lead =
      Atan2(lower_m * Sin(knee_flexion_rad), upper_m + lower_m * Cos(knee_flexion_rad));
  const Jet trail = knee_flexion_rad - lead;
  leg.upper_z = -Cos(lead) * e - Sin(lead) * front;
  leg.upper_x = Cross(leg.hinge, leg.upper_z);
  leg.lower_z = Sin(trail) * front - Cos(trail) * e;
  leg.lower_x = Cross(leg.hinge, leg.lower_z);
  return leg;
}

}  // namespace limbcast::simulation
