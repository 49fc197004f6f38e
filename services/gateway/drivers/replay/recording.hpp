#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/base/time.hpp"
#include "common/body/segment.hpp"
#include "common/body/segment_truth.hpp"
#include "common/sensing/fused_orientation.hpp"
#include "common/sensing/marg_sample.hpp"
#include "common/sensing/sensor_info.hpp"

namespace limbcast::gateway {

/// One sensor of a recording.
struct RecordedSensor {
  sensing::SensorInfo info;              ///< label = the name that the recording uses for it
  std::optional<body::Segment> segment;  ///< where it is worn, if the recording says so
};

/// All samples of one instant: the ones after those of the tick before, up to the given ends.
struct RecordedTick {
  Time at{};
  std::size_t marg_end = 0;
  std::size_t orientation_end = 0;
  std::size_t truth_end = 0;
  std::uint64_t device_lost = 0;  ///< samples missing before this tick by the device's own counter
};

/// A whole recording in memory, in SI units and our conventions, whatever its file format. Times
/// count from the recording's first sample (Time{} + offset). Samples stand in the order in which
/// they arrived; sequence and published_at are zero.
struct Recording {
  std::string format;    ///< "broad", "full_body", "xsens_text", "csv"
  std::string source;    ///< the path it was read from
  double rate_hz = 0.0;  ///< nominal; 0 = unknown
  std::vector<RecordedSensor> sensors;
  std::vector<sensing::MargSample> marg;
  std::vector<sensing::FusedOrientation> orientation;
  std::vector<body::SegmentTruth> truth;
  std::vector<RecordedTick> ticks;
  /// One for each tick: 1 while the person moves and the truth is to be compared (BROAD), else 0.
  /// Empty: the recording does not say.
  std::vector<std::uint8_t> movement;
  std::uint64_t out_of_order = 0;  ///< samples older than one before them; they are kept

  /// From the first to the last tick; zero without ticks.
  [[nodiscard]] Duration duration() const {
    return ticks.empty() ? Duration{} : ticks.back().at - ticks.front().at;
  }
};

/// What a reader may be told beside the path.
struct RecordingOptions {
  /// Appended to every serial number, so that one recording can be played as several people.
  std::string serial_suffix{};  // NOLINT(readability-redundant-member-init): lets callers name some
                                // fields only
  /// Where sensors are worn: label or serial number → segment name; over what the recording says.
  struct Assignment {
    std::string sensor;
    std::string segment;
  };
  std::vector<Assignment> assignments{};  // NOLINT(readability-redundant-member-init): as above
  /// Full scales, for recordings that do not say; 0 = unknown. At 99 % a reading counts as
  /// saturated.
  double gyro_range_rad_s = 0.0;
  double accel_range_m_s2 = 0.0;
  double mag_range_tesla = 0.0;
};

/// Time of row `index` at an even rate, to the nearest nanosecond.
[[nodiscard]] Time RowTime(std::size_t index, double rate_hz);

/// The info of a sensor that replay knows only by name: uid, driver "replay", serial, label, rate.
[[nodiscard]] sensing::SensorInfo MakeReplayInfo(const std::string& serial,
                                                 const std::string& label, double rate_hz,
                                                 const RecordingOptions& options);

/// Ends a tick at the present ends of the sample vectors.
void CloseTick(Recording& recording, Time at, std::uint64_t device_lost = 0);

/// Flags every magnetometer reading that repeats the one before it of the same sensor in all bits
/// (kMagHeld): recordings run at the rate of the gyroscope, and a slower magnetometer's last value
/// is written again and again. Two fresh readings that agree in all three axes would be flagged
/// too; with the noise of real ones this does not happen, and skipping one costs nothing.
void MarkHeldMagnetometer(Recording& recording);

/// Puts options.assignments over the recording's own segments. Fails with kInvalidArgument on an
/// unknown segment, an unknown sensor, or two sensors on one segment.
[[nodiscard]] Status Assign(Recording& recording, const RecordingOptions& options);

}  // namespace limbcast::gateway
