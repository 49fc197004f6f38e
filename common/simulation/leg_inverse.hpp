#pragma once

#include "common/simulation/jet.hpp"

namespace limbcast::simulation {

/// A leg of two bones between hip and ankle: the axes of its bones (x forward, y the common hinge
/// axis to the left, z up along the bone).
struct LegAxes {
  Jet3 hinge;
  Jet3 upper_x;
  Jet3 upper_z;
  Jet3 lower_x;
  Jet3 lower_z;
  Jet knee_flexion_rad;
};

/// Knee flexion for a distance d of hip and ankle (law of cosines); d is kept below the full length
/// smoothly, so that knee flexion never falls below about 4°. That is the identity up to 99.7 %.
[[nodiscard]] Jet KneeFlexion(const Jet& hip_to_ankle_m, double upper_m, double lower_m);

/// Distance of hip and ankle for a knee flexion: the inverse of KneeFlexion, also where the leg is
/// straight.
[[nodiscard]] Jet HipToAnkle(const Jet& knee_flexion_rad, double upper_m, double lower_m);

/// The leg from the unit vector hip→ankle, the way the knee points (horizontal unit vector), and
/// the knee flexion.
[[nodiscard]] LegAxes SolveLeg(const Jet3& hip_to_ankle, const Jet3& forward,
                               const Jet& knee_flexion_rad, double upper_m, double lower_m);

}  // namespace limbcast::simulation
