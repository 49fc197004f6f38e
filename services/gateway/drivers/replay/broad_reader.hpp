#pragma once

#include "common/base/result.hpp"
#include "services/gateway/drivers/replay/hdf5_file.hpp"
#include "services/gateway/drivers/replay/recording.hpp"

namespace limbcast::gateway {

/// True when `file` is laid out like a BROAD trial: /imu_gyr at the root.
[[nodiscard]] bool IsBroad(const Hdf5File& file);

/// Reads one trial of the BROAD data set (D. Laidig et al., Data 2021, 6(7), 72; fields in its
/// README): one MARG sensor at an even rate with optical truth. `name` (the file's name without
/// folder and extension) becomes serial number and label.
///
/// The one sensor is put on the pelvis with the identity as alignment, so the truth of the sensor
/// is also that of the segment, and opt_pos its position. Rows where the markers were not seen have
/// a truth that is flagged invalid.
[[nodiscard]] Result<Recording> ReadBroad(const Hdf5File& file, const std::string& name,
                                          const RecordingOptions& options);

}  // namespace limbcast::gateway
