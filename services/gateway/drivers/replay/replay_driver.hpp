#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

#include "common/base/result.hpp"
#include "common/config/config_file.hpp"
#include "services/gateway/driver.hpp"
#include "services/gateway/drivers/replay/recording.hpp"

namespace limbcast::gateway {

/// What to play. Section [replay] of a configuration.
struct ReplayConfig {
  /// File or folder; see ReadRecording for the formats.
  std::filesystem::path recording;

  /// Name of the person in the roster; empty = the name of the recording. At most 64 characters.
  std::string person;

  RecordingOptions options;
};

/// Reads the keys recording, person, serial_suffix, gyro_range_rad_s, accel_range_m_s2,
/// mag_range_tesla and the tables [[replay.assign]] {sensor, segment}.
[[nodiscard]] ReplayConfig ReadReplayConfig(const config::Section& section,
                                            ReplayConfig defaults = {});

/// Plays a recording as one person (body 1).
class ReplayDriver final : public Driver {
 public:
  /// Reads the whole recording into memory.
  [[nodiscard]] static Result<std::unique_ptr<ReplayDriver>> Make(const ReplayConfig& config);
  ReplayDriver(Recording recording, std::string person);

  [[nodiscard]] const DriverDescription& Describe() const override { return description_; }
  [[nodiscard]] Result<DriverStep> Next(Batch& batch) override;
  [[nodiscard]] Status Rewind() override;

  [[nodiscard]] const Recording& recording() const { return recording_; }

 private:
  Recording recording_;
  DriverDescription description_;
  std::size_t next_tick_ = 0;
};

}  // namespace limbcast::gateway
