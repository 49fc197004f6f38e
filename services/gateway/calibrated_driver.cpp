#include "services/gateway/calibrated_driver.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "services/gateway/calibration_file.hpp"
#include "services/gateway/sample_publisher.hpp"

namespace limbcast::gateway {

namespace {

// False for NaN, as in SamplePublisher.
bool AtLimit(const Eigen::Vector3f& reading, float range) {
  return range > 0.0F && (reading.array().abs() >= SamplePublisher::kSaturatedShare * range).any();
}

void FlagSaturation(const sensing::SensorInfo& info, sensing::MargSample& sample) {
  const auto flag = [&sample](const Eigen::Vector3f& reading, float range,
                              sensing::MargFlag missing, sensing::MargFlag saturated) {
    sample.flags |= !sample.Has(missing) && AtLimit(reading, range) ? saturated : 0U;
  };
  flag(sample.gyro_rad_s, info.gyro_range_rad_s, sensing::kGyroMissing, sensing::kGyroSaturated);
  flag(sample.accel_m_s2, info.accel_range_m_s2, sensing::kAccelMissing, sensing::kAccelSaturated);
  flag(sample.mag_tesla, info.mag_range_tesla, sensing::kMagMissing, sensing::kMagSaturated);
}

}  // namespace

CalibratedDriver::CalibratedDriver(std::unique_ptr<Driver> driver,
                                   const std::vector<sensing::SensorCalibration>& calibrations)
    : driver_(std::move(driver)), description_(driver_->Describe()) {
  for (sensing::SensorInfo& info : description_.sensors) {
    const auto found = std::find_if(
        calibrations.begin(), calibrations.end(),
        [&info](const auto& calibration) { return calibration.serial == info.serial; });
    if (found != calibrations.end()) {
      sensors_[info.sensor_uid] = {.calibration = *found, .info = info};
      info.calibration = found->Summary();
      info.calibrated_at = found->calibrated_at;
    }
  }
}

Result<DriverStep> CalibratedDriver::Next(Batch& batch) {
  Result<DriverStep> step = driver_->Next(batch);
  for (sensing::MargSample& sample : batch.marg) {
    if (const auto sensor = sensors_.find(sample.sensor_uid); sensor != sensors_.end()) {
      FlagSaturation(sensor->second.info, sample);
      sensor->second.calibration.Apply(sample);
    }
  }
  return step;
}

std::vector<sensing::SensorCalibration> LoadCalibrations(
    const std::filesystem::path& folder, const std::vector<sensing::SensorInfo>& sensors,
    std::vector<std::string>& warnings) {
  std::vector<sensing::SensorCalibration> found;
  for (const sensing::SensorInfo& info : sensors) {
    auto loaded = LoadCalibration(folder, info.serial);
    if (!loaded && loaded.error().code != ErrorCode::kNotFound) {
      warnings.push_back(loaded.error().message);
      loaded = LoadOldCalibration(folder, info.serial);
      warnings.back() += loaded ? "; the one before it is in force" : "; the sensor stays raw";
    }
    if (loaded) {
      found.push_back(*std::move(loaded));
    }
  }
  return found;
}

std::unique_ptr<Driver> WithCalibrations(std::unique_ptr<Driver> driver,
                                         const std::filesystem::path& folder) {
  if (folder.empty()) {
    return driver;
  }
  std::vector<std::string> warnings;
  const auto found = LoadCalibrations(folder, driver->Describe().sensors, warnings);
  for (const std::string& warning : warnings) {
    spdlog::warn("{}", warning);
  }
  spdlog::info("calibrations in {}: {} of {} sensors", folder.string(), found.size(),
               driver->Describe().sensors.size());
  if (found.empty()) {
    return driver;
  }
  return std::make_unique<CalibratedDriver>(std::move(driver), found);
}

}  // namespace limbcast::gateway
