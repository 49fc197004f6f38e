#pragma once

#include <cstdint>

#include "common/sensing/coil_frame.hpp"
#include "common/sensing/marg_sample.hpp"

namespace limbcast::sensing {

/// More bits of MargSample::flags, part of the wire contract as those of MargFlag: the coil of this
/// body's own source that was on, at most one. With kCoilPulseActive and none of them the
/// magnetometer's reading means nothing (settling, or another source's slot).
inline constexpr std::uint32_t kCoilXOn = 1U << 10U;
inline constexpr std::uint32_t kCoilYOn = 1U << 11U;
inline constexpr std::uint32_t kCoilZOn = 1U << 12U;
inline constexpr std::uint32_t kCoilReversed = 1U << 13U;  ///< its current flows the other way

inline constexpr std::uint32_t kAnyCoilOn = kCoilXOn | kCoilYOn | kCoilZOn;

/// What a sample's flags say of the source while it was taken. Nothing when no pulse is on: the
/// magnetometer shows the earth's field.
[[nodiscard]] inline std::uint32_t CoilFlagsOf(const CoilDrive& drive) {
  if (!drive.settled) {
    return kCoilPulseActive;
  }
  if (drive.coil < 0 || drive.coil > 2) {
    return 0;
  }
  return kCoilPulseActive | (kCoilXOn << static_cast<unsigned>(drive.coil)) |
         (drive.current_a < 0.0 ? kCoilReversed : 0U);
}

/// The inverse. Flags that name more than one coil say nothing that can be used.
///
/// @param current_a  of the source, > 0.
[[nodiscard]] inline CoilDrive CoilDriveOf(std::uint32_t flags, double current_a) {
  CoilDrive drive;
  if ((flags & kCoilPulseActive) == 0) {
    return drive;
  }
  const std::uint32_t on = flags & kAnyCoilOn;
  drive.settled = on == kCoilXOn || on == kCoilYOn || on == kCoilZOn;
  if (drive.settled) {
    drive.coil = on == kCoilXOn ? 0 : on == kCoilYOn ? 1 : 2;
    drive.current_a = (flags & kCoilReversed) != 0 ? -current_a : current_a;
  }
  return drive;
}

}  // namespace limbcast::sensing
