#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.hpp"
#include "services/gateway/drivers/replay/recording.hpp"

namespace limbcast::gateway {

/// True when the first lines of `text` look like a text export of Xsens' software: a header of "//"
/// lines and then a line of column names with PacketCounter.
[[nodiscard]] bool IsXsensText(std::string_view text);

/// One exported file.
struct XsensFile {
  std::string name;    ///< for messages
  std::string serial;  ///< the sensor's; the last part of the file's name: MT_..._00B42268.txt
  std::string text;
};

/// The text exports in a folder, in the order of their names; other files are left out. kNotFound
/// when there are none.
[[nodiscard]] Result<std::vector<XsensFile>> LoadXsensFolder(const std::filesystem::path& folder);

/// Reads text exports, one file for each sensor: tab-separated columns PacketCounter, Acc_X..Z
/// (m/s², specific force), Mat[1..3][1..3] (rotation matrix sensor to earth) and, where there,
/// Gyr_X..Z (rad/s). The columns are found by name. Time is the packet counter (16 bit, wraps) at
/// the header's "Update Rate"; packets that the counter skips are counted in device_lost. The
/// orientations are published as they are: the heading's reference is not in the files, so it is
/// called arbitrary. The files do not say where a sensor was worn: see
/// RecordingOptions::assignments.
[[nodiscard]] Result<Recording> ReadXsensText(const std::vector<XsensFile>& files,
                                              const RecordingOptions& options);

}  // namespace limbcast::gateway
