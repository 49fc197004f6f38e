#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "common/sensing/sensor_calibration.hpp"
#include "services/gateway/driver.hpp"

namespace limbcast::gateway {

/// A driver whose MARG readings are corrected by the calibrations of its sensors. Its description
/// says which are in force (SensorInfo::calibration, calibrated_at). Saturation is judged on the
/// raw readings, before they are corrected. Readings of sensors with their own filter stay as they
/// are: their orientation came from the raw ones.
class CalibratedDriver final : public Driver {
 public:
  CalibratedDriver(std::unique_ptr<Driver> driver,
                   const std::vector<sensing::SensorCalibration>& calibrations);

  [[nodiscard]] const DriverDescription& Describe() const override { return description_; }
  [[nodiscard]] Result<DriverStep> Next(Batch& batch) override;
  [[nodiscard]] Status FollowSlots(const CoilSchedule& schedule) override {
    return driver_->FollowSlots(schedule);
  }
  [[nodiscard]] Status Rewind() override { return driver_->Rewind(); }
  void Interrupt() override { driver_->Interrupt(); }

 private:
  struct Sensor {
    sensing::SensorCalibration calibration;
    sensing::SensorInfo info;
  };
  std::unique_ptr<Driver> driver_;
  DriverDescription description_;
  std::unordered_map<SensorUid, Sensor> sensors_;
};

/// The calibrations in `folder` for these sensors, by serial. A file that cannot be read costs a
/// line in `warnings`, and the one before it is taken where that is still good. Sensors without a
/// file stay as they are.
[[nodiscard]] std::vector<sensing::SensorCalibration> LoadCalibrations(
    const std::filesystem::path& folder, const std::vector<sensing::SensorInfo>& sensors,
    std::vector<std::string>& warnings);

/// `driver` with what `folder` has for its sensors; an empty folder name or nothing found gives the
/// driver itself. Warnings go to the log.
[[nodiscard]] std::unique_ptr<Driver> WithCalibrations(std::unique_ptr<Driver> driver,
                                                       const std::filesystem::path& folder);

}  // namespace limbcast::gateway
