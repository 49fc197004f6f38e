#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/filters/position/coil_inertial_config.hpp"
#include "common/simulation/coil_stream.hpp"

namespace limbcast::filters {

/// A sensor that swings 25 to 45 cm above a source that moves as well (or is fixed), for tests.
/// Still for the first 2.5 s.
[[nodiscard]] simulation::CoilStreamConfig SwingStream(bool moving_source,
                                                       const simulation::CoilPulseConfig& pulses);
/// A recording of it.
[[nodiscard]] std::vector<simulation::CoilTick> SwingingSensor(
    bool moving_source, const simulation::CoilPulseConfig& pulses, double duration_s,
    std::uint64_t seed);

/// Spoils some frames in a hundred from the one with index `first` on: readings that are not
/// finite, a clipped magnetometer, a time that comes again.
void SpoilFrames(std::vector<simulation::CoilTick>& ticks, std::size_t first);

/// The filter's configuration for it: 50 nT, upper half space.
[[nodiscard]] CoilInertialConfig SwingConfig();

}  // namespace limbcast::filters
