#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "common/filters/position/coil_pulse_collector.hpp"
#include "services/gateway/driver.hpp"

namespace limbcast::gateway {

/// A driver whose people wear coil sources, with the pulses taken out of the magnetometer samples
/// (design/position.md sections 7, 11 and 13). What each source does is in Batch::coil_drives.
///
/// Each sample says by its flags whether a coil of its own body's source was on, and which
/// (sensing::CoilFlagsOf): orientation filters leave such a reading alone, the position filter
/// measures with it. Readings that mean nothing (settling after an edge, another source's slot, a
/// current that was not measured or is more than 5 % off) are kCoilPulseActive without a coil.
///
/// Slots that the roster grants to sources of other gateways are masked whole, whether or not those
/// pulse in them.
///
/// Each completed pulse becomes one CoilBurst with that one pulse in it: earth field removed with
/// the attitude that the gyroscope integrates, in sensor axes of the pulse's middle. A pulse that
/// does not stand out of the noise by 3 σ is there and not valid.
///
/// Thread-compatible; allocates nothing after construction but what grows in the batch.
class CoilPulseDriver final : public Driver {
 public:
  static constexpr double kCurrentTolerance = 0.05;
  static constexpr double kVisibleSigmas = 3.0;

  /// @param driver  describes at least one coil source.
  explicit CoilPulseDriver(std::unique_ptr<Driver> driver);

  [[nodiscard]] const DriverDescription& Describe() const override { return driver_->Describe(); }
  [[nodiscard]] Result<DriverStep> Next(Batch& batch) override;
  [[nodiscard]] Status FollowSlots(const CoilSchedule& schedule) override;
  [[nodiscard]] Status Rewind() override;
  void Interrupt() override { driver_->Interrupt(); }

 private:
  struct Source {
    CoilSourceInfo info;
    sensing::CoilDrive drive;  // of this tick, masked while others pulse
    bool active = false;       // by what it says itself: it pulses, or settles
    int coil_before = -1;
    Time on_at{};   // of the pulse that is on, or was last
    Time off_at{};  // zero while it is on
  };
  struct Sensor {
    std::optional<std::size_t> source;  // that of its body
    std::optional<filters::CoilPulseCollector> collector;
    std::optional<sensing::MargSample> last;
    filters::CoilPath path;
    std::uint32_t sequence = 0;
  };

  void Forget();
  void TakeDrives(const Batch& batch, bool foreign);
  void TakeSlots();
  [[nodiscard]] bool IsForeign(Time tick_at) const;
  void Extract(Sensor& sensor, const sensing::MargSample& sample, std::vector<sensing::CoilBurst>&);
  static void Turn(Sensor& sensor, const sensing::MargSample& sample);

  std::unique_ptr<Driver> driver_;
  CoilSchedule schedule_;
  std::vector<Source> sources_;
  std::unordered_map<SensorUid, Sensor> sensors_;
};

/// The driver itself when nobody of it wears coils.
[[nodiscard]] std::unique_ptr<Driver> WithCoilPulses(std::unique_ptr<Driver> driver);

}  // namespace limbcast::gateway
