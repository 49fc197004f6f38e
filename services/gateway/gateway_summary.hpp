#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/base/health.hpp"
#include "services/gateway/sample_publisher.hpp"

namespace limbcast::gateway {

/// One sensor in the summary.
struct SensorSummary {
  std::string label;
  std::uint64_t published = 0;
  std::uint64_t unanswered = 0;  ///< only as fast as possible, where answers are waited for
};

/// What a gateway has done, at its end or so far.
struct GatewaySummary {
  std::string driver;
  std::string source;
  std::string end = "running";  ///< "running", "end_of_data", "stopped", "failed"
  std::string error;            ///< the last one; "" when all was well
  std::uint32_t bodies = 0;
  std::uint32_t sensors = 0;
  std::uint64_t ticks = 0;
  std::uint64_t loops = 0;
  PublishCounters published;
  std::uint64_t device_lost = 0;         ///< lost before the gateway, by the device's own counter
  std::uint64_t time_jumps = 0;          ///< the sender was too late to catch up
  std::uint64_t samples_unanswered = 0;  ///< by fusion within the deadline
  std::uint64_t ticks_unanswered = 0;    ///< by posture within the deadline
  std::uint64_t late_answers = 0;
  std::uint64_t link_losses = 0;  ///< times that nobody answered any more
  bool wait_timed_out = false;
  double waited_s = 0.0;
  double stream_s = 0.0;  ///< of recording time sent
  double wall_s = 0.0;    ///< from the first to the last tick
  double max_lag_ms = 0.0;
  std::vector<SensorSummary> by_sensor;
};

/// One JSON object, several lines. Keys: those of the struct; the published ones are
/// samples_published (marg and orientation), marg_published, orientation_published,
/// truth_published, samples_saturated, samples_mag_missing and write_errors.
[[nodiscard]] std::string ToJson(const GatewaySummary& summary);

/// Adds the summary's counters to `health.values` ("samples.published", ...).
void AddValues(const GatewaySummary& summary, ServiceHealth& health);

/// One line for people.
[[nodiscard]] std::string ToText(const GatewaySummary& summary);

}  // namespace limbcast::gateway
