#pragma once

#include "common/base/result.hpp"
#include "services/gateway/drivers/replay/hdf5_file.hpp"
#include "services/gateway/drivers/replay/recording.hpp"

namespace limbcast::gateway {

/// True when `file` holds a /time dataset and groups with imu_acc.
[[nodiscard]] bool IsFullBody(const Hdf5File& file);

/// Reads a full-body HDF5 recording: /time (N, seconds) and one group for each sensor, named after
/// its segment, with imu_acc (N × 3, m/s²) and imu_gyr (N × 3, rad/s). There is no magnetometer:
/// every sample is flagged so. Group names are segment names; lower_back (l5), upper_back (t8) and
/// left_/right_forearm are understood too, and any other group is a sensor without a segment.
///
/// `name` (the file's name without folder and extension) goes in front of each serial number.
[[nodiscard]] Result<Recording> ReadFullBody(const Hdf5File& file, const std::string& name,
                                             const RecordingOptions& options);

}  // namespace limbcast::gateway
