#pragma once

#include <cstdint>
#include <optional>

#include "tools/limbcast/evaluate/coil_trial.hpp"
#include "tools/limbcast/evaluate/gap_trial.hpp"

namespace limbcast::tool {

/// A real inertial unit under a source of coils that was not there: rates and forces are those of
/// the recording; the truth is where the fixed-interval smoother of the optical + inertial filter
/// puts the inertial unit itself (lever arm to the marker, time offset and the unit's delays taken
/// into account); the magnetometer is simulated at that place, at 120 Hz or the recording's rate if
/// that is lower:
///
///   y = R_sᵀ (m_e + G L sin(p/L) + b) + n
///
/// The source stands with its axes along the earth frame, 15 cm outside the box that the unit stays
/// in, on its thinnest side and at the mean place otherwise, without an inertial unit. That the
/// unit is on this side is known. Begins 5 s before the first row in motion; all rows in motion
/// count. The filter has its defaults, but for the noise of the magnetometer.
///
/// @returns nothing when the recording has no motion that the smoother finds an attitude in.
[[nodiscard]] std::optional<CoilTrial> MakeCoilTrial(const GapTrial& recording, CoilNoise noise,
                                                     std::uint64_t seed);

}  // namespace limbcast::tool
