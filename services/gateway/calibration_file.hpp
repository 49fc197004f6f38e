#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "common/base/result.hpp"
#include "common/sensing/sensor_calibration.hpp"

namespace limbcast::gateway {

/// One sensor's calibration as a TOML file, <folder>/<serial>.toml. A new one is written beside the
/// old one, read back, and only then put in its place; the old one stays as <serial>.toml.old. The
/// last line says that the file is whole.

/// "00B42279.toml"; characters other than letters, digits, '-', '_' and '.' become %XX.
[[nodiscard]] std::string CalibrationFileName(const std::string& serial);

/// The file's text; `calibration` is valid.
[[nodiscard]] std::string CalibrationToToml(const sensing::SensorCalibration& calibration);

/// Reads such a text; `name` stands for the file in messages. Refuses with one line what is not
/// whole, has unknown keys, or cannot be a sensor's (sensing::Validate).
[[nodiscard]] Result<sensing::SensorCalibration> CalibrationFromToml(std::string_view text,
                                                                     const std::string& name);

/// kNotFound: no such file; kCorruptData: the calibration of another sensor, or as above.
[[nodiscard]] Result<sensing::SensorCalibration> LoadCalibration(
    const std::filesystem::path& folder, const std::string& serial);

/// What stays after a new file was spoiled: <serial>.toml.old.
[[nodiscard]] Result<sensing::SensorCalibration> LoadOldCalibration(
    const std::filesystem::path& folder, const std::string& serial);

/// Writes the file of calibration.serial atomically (a reader sees the old or the new one). Makes
/// the folder. Fails with kUnavailable and leaves what was there.
[[nodiscard]] Status SaveCalibration(const std::filesystem::path& folder,
                                     const sensing::SensorCalibration& calibration);

}  // namespace limbcast::gateway
