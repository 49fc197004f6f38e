#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "common/bus/bus.hpp"
#include "services/gateway/driver.hpp"
#include "services/gateway/gateway_config.hpp"

namespace limbcast::gateway {

/// One sensor as the publisher keeps it.
struct SensorStream {
  SensorUid uid;
  std::string label;
  std::int32_t body = -1;  ///< index into the description's bodies; -1 = worn by nobody we know
  std::uint32_t marg_sequence = 0;         ///< of the last sample sent, from 1
  std::uint32_t orientation_sequence = 0;  ///< the same for the topic orientation
  float gyro_limit_rad_s = 0.0F;           ///< at this it counts as saturated
  float accel_limit_m_s2 = 0.0F;
  float mag_limit_tesla = 0.0F;
};

struct PublishCounters {
  std::uint64_t marg = 0;
  std::uint64_t orientation = 0;
  std::uint64_t markers = 0;
  std::uint64_t coil_bursts = 0;
  std::uint64_t truth = 0;
  std::uint64_t saturated = 0;    ///< samples with at least one saturated channel
  std::uint64_t mag_missing = 0;  ///< samples without a magnetometer reading
  std::uint64_t write_errors = 0;
};

/// Numbers, flags and writes samples. Knows the bus and nothing of pacing. Thread-compatible.
class SamplePublisher {
 public:
  /// Readings at this share of the full scale count as saturated.
  static constexpr float kSaturatedShare = 0.99F;

  /// Makes the writers. `clock` and `bus` outlive it.
  [[nodiscard]] static Result<std::unique_ptr<SamplePublisher>> Make(
      const GatewayConfig& config, const DriverDescription& description, const Clock& clock,
      bus::Bus& bus);

  /// Publishes sensor_info for every sensor and, by configuration, the roster.
  [[nodiscard]] Status Announce(const DriverDescription& description);
  /// Takes sensor_info back: the sensors are gone.
  void Withdraw(const DriverDescription& description);

  /// Gives sequence numbers and saturation flags to all samples, and finds their streams.
  void Stamp(Batch& batch);
  /// Streams of the samples of the last stamped batch, in their order.
  [[nodiscard]] const std::vector<std::size_t>& marg_streams() const { return marg_streams_; }
  [[nodiscard]] const std::vector<std::size_t>& orientation_streams() const {
    return orientation_streams_;
  }

  /// Writes a stamped batch back to back: markers, samples, coil bursts, truth, each with one
  /// flush. published_at is set to the moment of each write.
  void Write(Batch& batch);

  /// Writes a link probe for every sensor that somebody wears.
  void WriteProbes(Time measured_at);

  /// Readers of both sample topics are there.
  [[nodiscard]] bool HasReaders() const;

  [[nodiscard]] const std::vector<SensorStream>& streams() const { return streams_; }
  [[nodiscard]] const PublishCounters& counters() const { return counters_; }
  [[nodiscard]] const std::string& last_error() const { return last_error_; }

 private:
  SamplePublisher(const GatewayConfig& config, const DriverDescription& description,
                  const Clock& clock);
  template <typename T>
  [[nodiscard]] static Status MakeWriter(bus::Bus& bus, std::unique_ptr<bus::Writer<T>>& writer);
  std::size_t StreamOf(SensorUid uid);
  void FlagSaturation(const SensorStream& stream, sensing::MargSample& sample);
  void WriteMarg(std::vector<sensing::MargSample>& samples,
                 const std::vector<std::size_t>& streams);
  void WriteFrames(std::vector<sensing::MargSample>& samples,
                   const std::vector<std::size_t>& streams);
  void SendFrame(sensing::MargFrame& frame);
  template <typename T>
  void Send(bus::Writer<T>& writer, const T& value);
  template <typename T>
  void SendAll(bus::Writer<T>& writer, std::vector<T>& values);

  const bool marg_frame_;
  const bool publish_roster_;
  const bool publish_truth_;
  const Clock& clock_;
  std::unique_ptr<bus::Writer<sensing::MargSample>> marg_writer_;
  std::unique_ptr<bus::Writer<sensing::MargFrame>> frame_writer_;
  std::unique_ptr<bus::Writer<sensing::FusedOrientation>> orientation_writer_;
  std::unique_ptr<bus::Writer<sensing::MarkerPosition>> marker_writer_;
  std::unique_ptr<bus::Writer<sensing::CoilBurst>> burst_writer_;
  std::unique_ptr<bus::Writer<body::SegmentTruth>> truth_writer_;
  std::unique_ptr<bus::Writer<sensing::SensorInfo>> info_writer_;
  std::unique_ptr<bus::Writer<roster::RosterEntry>> roster_writer_;

  std::vector<SensorStream> streams_;
  std::unordered_map<SensorUid, std::size_t> stream_of_;
  std::vector<sensing::MargFrame> frames_;  // one for each body, reused
  std::vector<std::size_t> marg_streams_;
  std::vector<std::size_t> orientation_streams_;
  std::vector<sensing::MargSample> probes_;
  std::vector<std::size_t> probe_streams_;
  PublishCounters counters_;
  std::string last_error_;
};

}  // namespace limbcast::gateway
