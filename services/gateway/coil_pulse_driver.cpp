#include "services/gateway/coil_pulse_driver.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/expects.hpp"
#include "common/math/rotation.hpp"
#include "common/sensing/coil_flags.hpp"

namespace limbcast::gateway {

namespace {

constexpr double kLongestGap_s = 0.1;  // of a sensor: the attitude over it is not known
constexpr std::uint32_t kMagUseless =
    sensing::kMagMissing | sensing::kMagSaturated | sensing::kMagHeld;

}  // namespace

CoilPulseDriver::CoilPulseDriver(std::unique_ptr<Driver> driver) : driver_(std::move(driver)) {
  Forget();
}

void CoilPulseDriver::Forget() {
  const DriverDescription& description = driver_->Describe();
  Expects(!description.coil_sources.empty(), "a driver with coil sources");
  sources_.clear();
  sensors_.clear();
  for (const CoilSourceInfo& info : description.coil_sources) {
    sources_.emplace_back().info = info;
  }
  TakeSlots();
  for (const roster::RosterEntry& body : description.bodies) {
    const auto own = std::find_if(sources_.begin(), sources_.end(), [&](const Source& source) {
      return source.info.body_id == body.body_id;
    });
    for (const roster::SensorAssignment& assignment : body.sensors) {
      Sensor& sensor = sensors_[assignment.sensor_uid];
      if (own == sources_.end()) {
        continue;
      }
      sensor.source = static_cast<std::size_t>(own - sources_.begin());
      const auto& listed = own->info.sensors;
      if (std::find(listed.begin(), listed.end(), assignment.sensor_uid) != listed.end()) {
        sensor.collector.emplace(own->info.sigma_mag_tesla,
                                 filters::CoilPulseCollector::kBackgroundAfterLive);
      }
    }
  }
}

void CoilPulseDriver::TakeSlots() {
  for (Source& source : sources_) {
    if (const auto grant = schedule_.Of(source.info.body_id)) {
      source.info.slot = grant->slot;
    }
  }
}

Status CoilPulseDriver::FollowSlots(const CoilSchedule& schedule) {
  schedule_ = schedule;
  TakeSlots();
  return driver_->FollowSlots(schedule);
}

bool CoilPulseDriver::IsForeign(Time tick_at) const {
  return std::any_of(schedule_.foreign.begin(), schedule_.foreign.end(),
                     [&](const sensing::CoilGrant& grant) {
                       return sensing::IsInSlot(grant, tick_at + schedule_.to_host);
                     });
}

Status CoilPulseDriver::Rewind() {
  Status rewound = driver_->Rewind();
  if (rewound) {
    Forget();
  }
  return rewound;
}

void CoilPulseDriver::TakeDrives(const Batch& batch, bool foreign) {
  for (Source& source : sources_) {
    const auto said = std::find_if(
        batch.coil_drives.begin(), batch.coil_drives.end(),
        [&](const CoilSourceDrive& drive) { return drive.source_uid == source.info.source_uid; });
    source.drive = {.settled = false};  // a source that says nothing may do anything
    if (said != batch.coil_drives.end()) {
      source.drive = said->drive;
    }
    source.active = source.drive.coil >= 0 || !source.drive.settled;
    if (source.drive.coil >= 0 && source.coil_before < 0) {
      source.on_at = batch.tick_at;
      source.off_at = Time{};
    } else if (source.drive.coil < 0 && source.coil_before >= 0) {
      source.off_at = batch.tick_at;
    }
    source.coil_before = source.drive.coil;
    // Comparisons that are false for NaN.
    const double off = std::abs(std::abs(source.drive.current_a) - source.info.current_a);
    if (source.drive.coil >= 0 && !(off <= kCurrentTolerance * source.info.current_a)) {
      source.drive.settled = false;
    }
  }
  for (Source& source : sources_) {
    const bool disturbed =
        foreign || std::any_of(sources_.begin(), sources_.end(), [&](const Source& other) {
          return other.active && other.info.slot != source.info.slot;
        });
    source.drive.settled = source.drive.settled && !disturbed;
  }
}

void CoilPulseDriver::Turn(Sensor& sensor, const sensing::MargSample& sample) {
  if (!sensor.last) {
    return;
  }
  const double dt_s = ToSeconds(sample.measured_at - sensor.last->measured_at);
  if (dt_s > kLongestGap_s) {
    sensor.collector->Clear();
    return;
  }
  const Eigen::Vector3d turn_rad =
      0.5 * dt_s * (sensor.last->gyro_rad_s + sample.gyro_rad_s).cast<double>();
  sensor.path.q_earth_sensor = (sensor.path.q_earth_sensor * math::ExpSO3(turn_rad)).normalized();
}

void CoilPulseDriver::Extract(Sensor& sensor, const sensing::MargSample& given,
                              std::vector<sensing::CoilBurst>& bursts) {
  if (sensor.last && given.measured_at <= sensor.last->measured_at) {
    return;
  }
  sensing::MargSample sample = given;
  if (sample.Has(sensing::kGyroMissing) || !sample.gyro_rad_s.allFinite()) {
    sample.gyro_rad_s =
        sensor.last ? sensor.last->gyro_rad_s : Eigen::Vector3f(Eigen::Vector3f::Zero());
  }
  Turn(sensor, sample);
  sensor.last = sample;
  const Source& source = sources_[*sensor.source];
  sensing::CoilFrame frame;
  frame.measured_at = sample.measured_at;
  frame.mag_tesla = sample.mag_tesla.cast<double>();
  frame.mag_valid = (sample.flags & kMagUseless) == 0;
  frame.drive = source.drive;
  if (!sensor.collector->Update(frame, sensor.path)) {
    return;
  }
  const filters::CollectedPulse& pulse = sensor.collector->newest();
  sensing::CoilBurst burst;
  burst.sensor_uid = sample.sensor_uid;
  burst.source_uid = source.info.source_uid;
  burst.sequence = ++sensor.sequence;
  burst.slot = source.info.slot;
  burst.measured_at = pulse.middle_at;
  sensing::CoilPulse& into = burst.pulses[static_cast<std::size_t>(pulse.coil)];
  into.on_at = source.on_at;
  into.off_at = source.off_at == Time{} ? sample.measured_at : source.off_at;
  into.current_a = static_cast<float>(pulse.current_a);
  into.field_tesla =
      (pulse.path.q_earth_sensor.conjugate() * pulse.field_earth_tesla).cast<float>();
  into.sigma_tesla = static_cast<float>(pulse.sigma_tesla);
  into.valid = into.field_tesla.allFinite() &&
               pulse.field_earth_tesla.norm() > kVisibleSigmas * pulse.sigma_tesla;
  bursts.push_back(burst);
}

Result<DriverStep> CoilPulseDriver::Next(Batch& batch) {
  Result<DriverStep> step = driver_->Next(batch);
  if (!step || *step != DriverStep::kData) {
    return step;
  }
  const bool foreign = IsForeign(batch.tick_at);
  TakeDrives(batch, foreign);
  const bool any = foreign || std::any_of(sources_.begin(), sources_.end(),
                                          [](const Source& source) { return source.active; });
  for (sensing::MargSample& sample : batch.marg) {
    const auto found = sensors_.find(sample.sensor_uid);
    if (found == sensors_.end() || !found->second.source) {
      // Somebody's field, of which nothing is known here.
      sample.flags |= any ? static_cast<std::uint32_t>(sensing::kCoilPulseActive) : 0U;
      continue;
    }
    sample.flags |= sensing::CoilFlagsOf(sources_[*found->second.source].drive);
    if (found->second.collector) {
      Extract(found->second, sample, batch.coil_bursts);
    }
  }
  return step;
}

std::unique_ptr<Driver> WithCoilPulses(std::unique_ptr<Driver> driver) {
  if (driver->Describe().coil_sources.empty()) {
    return driver;
  }
  return std::make_unique<CoilPulseDriver>(std::move(driver));
}

}  // namespace limbcast::gateway
