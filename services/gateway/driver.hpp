#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/base/time.hpp"
#include "common/body/segment_truth.hpp"
#include "common/roster/roster.hpp"
#include "common/sensing/coil_burst.hpp"
#include "common/sensing/coil_frame.hpp"
#include "common/sensing/coil_slots.hpp"
#include "common/sensing/fused_orientation.hpp"
#include "common/sensing/marg_sample.hpp"
#include "common/sensing/position_samples.hpp"
#include "common/sensing/sensor_info.hpp"

namespace limbcast::gateway {

/// Whose clock the times in a Batch are on, and therefore who paces.
enum class DriverTime : std::uint8_t {
  /// Recordings and simulators: `measured_at` counts from the epoch (Time{} + offset from the
  /// recording's first sample, so the first is about zero). Next never blocks; the gateway decides
  /// when a tick is due and maps its times to now.
  kRecording,
  /// Devices: `measured_at` is host time (the driver maps its device's clock with a ClockMap). Next
  /// blocks until data is there; the gateway publishes at once.
  kHost,
};

/// A source of three coils that somebody wears.
struct CoilSourceInfo {
  /// The inertial unit that the coils are fixed to: its axes and place are theirs.
  SensorUid source_uid;
  BodyId body_id;  ///< who wears it, as in DriverDescription::bodies
  /// Sources with different slots may be near enough to disturb one another, so each is masked
  /// while the other pulses; those with the same slot are not.
  std::uint32_t slot = 0;
  std::vector<SensorUid> sensors;  ///< on the same body, whose pulses are to be published
  double sigma_mag_tesla = 50e-9;  ///< noise of one reading of theirs, one axis
  double current_a = 0.0;          ///< nominal, > 0
};

/// What a source does while the samples of a tick are taken.
struct CoilSourceDrive {
  SensorUid source_uid;
  sensing::CoilDrive drive;  ///< of which the current is measured: NaN when that failed
};

/// What a driver knows before the first sample. Fixed for the driver's life.
struct DriverDescription {
  std::string driver;  ///< "simulator", "replay", ... (at most 32 characters)
  std::string source;  ///< file, model or port, for people
  DriverTime time = DriverTime::kRecording;
  double tick_rate_hz = 0.0;  ///< nominal ticks a second; 0 = unknown
  std::vector<sensing::SensorInfo> sensors;
  /// Who wears what, as far as the driver knows; may be empty (then a session host must say). With
  /// revision 1 and an empty session; the gateway may change body ids and fills the session.
  std::vector<roster::RosterEntry> bodies;
  bool has_truth = false;  ///< batches carry SegmentTruth
  std::vector<CoilSourceInfo> coil_sources;
};

/// All that one tick brings: the samples of all sensors that belong to one instant (or, for live
/// devices, that came together). The gateway keeps one Batch and hands it to every Next, so that
/// nothing is allocated once its vectors have grown.
struct Batch {
  /// When the tick is due, on the same scale as the samples' `measured_at`; grows strictly from one
  /// batch to the next. Usually the largest `measured_at`.
  Time tick_at{};
  /// Filled in by the driver: sensor_uid, measured_at, readings, and the flags that only it can
  /// know (missing channels, kMagHeld, kCoilPulseActive; saturation if the device tells). Left to
  /// the gateway: sequence, published_at, saturation by range. Readings are never invented: what is
  /// not there is zero and flagged missing; what is not finite goes through as it is.
  std::vector<sensing::MargSample> marg;
  std::vector<sensing::FusedOrientation> orientation;
  /// Of cameras; left to the gateway: published_at. They go out before the samples, so that a
  /// filter that reads on meets a marker no later than the reading of its instant.
  std::vector<sensing::MarkerPosition> markers;
  /// What each of the description's sources does now. The gateway takes the pulses out of the
  /// samples (coil_pulse_driver), so a driver that gives this leaves kCoilPulseActive and
  /// coil_bursts alone.
  std::vector<CoilSourceDrive> coil_drives;
  /// Coil pulses that were completed by this tick's readings; left to the gateway: published_at.
  std::vector<sensing::CoilBurst> coil_bursts;
  std::vector<body::SegmentTruth> truth;
  /// Samples that the device or recording lost before this tick (e.g. gaps in a packet counter).
  std::uint64_t device_lost = 0;

  void Clear() {
    tick_at = Time{};
    marg.clear();
    orientation.clear();
    markers.clear();
    coil_drives.clear();
    coil_bursts.clear();
    truth.clear();
    device_lost = 0;
  }
};

/// Who may pulse when, as the roster of the session has it.
struct CoilSchedule {
  struct Own {
    BodyId body_id;
    std::optional<sensing::CoilGrant> grant;  ///< none: this source does not pulse
  };
  std::vector<Own> own;
  std::vector<sensing::CoilGrant> foreign;  ///< of sources of other gateways
  Duration to_host{};  ///< host time minus the driver's; zero for DriverTime::kHost

  /// What one of its own people is granted; nothing for others.
  [[nodiscard]] std::optional<sensing::CoilGrant> Of(BodyId body) const {
    const auto found =
        std::find_if(own.begin(), own.end(), [&](const Own& one) { return one.body_id == body; });
    return found == own.end() ? std::nullopt : found->grant;
  }
};

enum class DriverStep : std::uint8_t {
  kData,     ///< the batch holds a tick
  kWaiting,  ///< nothing yet (live devices, at most 100 ms after the call); call again
  kEnd,      ///< no more data; the batch is empty
};

/// A source of sensor data, to the gateway service all the same: simulator, recording, device.
/// Knows no DDS, no pacing, no sequence numbers. Thread-compatible: the gateway calls Describe,
/// Next and Rewind from one thread at a time; only Interrupt comes from another.
class Driver {
 public:
  virtual ~Driver() = default;

  [[nodiscard]] virtual const DriverDescription& Describe() const = 0;

  /// Clears `batch` and fills it with the next tick. An Error is final for this attempt: the
  /// gateway reports it in `health`, and ends (recordings) or calls Next again after a pause
  /// (devices).
  [[nodiscard]] virtual Result<DriverStep> Next(Batch& batch) = 0;

  /// From the next tick on sources of coils keep to this schedule; without one they pulse as the
  /// driver is configured. Called between ticks when anything in it has changed. Fails where pulses
  /// do not fit into their slots: the sources concerned then do not pulse.
  [[nodiscard]] virtual Status FollowSlots(const CoilSchedule& schedule) {
    static_cast<void>(schedule);
    return Ok();
  }

  /// Goes back to the first tick; batches then start again at the same `tick_at`. kUnsupported
  /// where that makes no sense (devices; a simulator that never ends).
  [[nodiscard]] virtual Status Rewind() {
    return Error{ErrorCode::kUnsupported, "this driver cannot start again from the beginning"};
  }

  /// Makes a blocked Next return kWaiting soon. Callable from any thread. Drivers that never block
  /// leave it empty.
  virtual void Interrupt() {}
};

}  // namespace limbcast::gateway
