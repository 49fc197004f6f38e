#pragma once

#include <span>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/sensing/marg_sample.hpp"
#include "common/sensing/sensor_info.hpp"

namespace limbcast::tool {

/// One sensor and all its samples, in order of time.
struct SensorSamples {
  sensing::SensorInfo info;
  std::vector<sensing::MargSample> samples;
  std::string limb;  ///< name of the segment that wears it; "" = not known

  /// The label, with the serial behind it where it is another, and who wears it.
  [[nodiscard]] std::string Name() const;
};

/// Sorts samples by sensor and time; of two at the same time the first stays. With `chosen` only
/// the sensor of that label or serial. kNotFound: no such sensor (the message lists them), or no
/// MARG samples at all.
[[nodiscard]] Result<std::vector<SensorSamples>> SamplesBySensor(
    std::span<const sensing::SensorInfo> sensors, std::span<const sensing::MargSample> samples,
    const std::string& chosen);

}  // namespace limbcast::tool
