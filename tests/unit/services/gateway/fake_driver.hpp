#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/base/ids.hpp"
#include "services/gateway/driver.hpp"

namespace limbcast::gateway::test {

/// A driver whose every answer the test has written down. Sensor i of n has uid i + 1 and sits on
/// segment i of body 1. Ticks are 10 ms apart.
class FakeDriver final : public Driver {
 public:
  explicit FakeDriver(std::size_t sensors, std::size_t ticks = 0) : ticks_(ticks) {
    description_.driver = "fake";
    description_.source = "fake";
    description_.tick_rate_hz = 100.0;
    roster::RosterEntry entry;
    entry.body_id = BodyId{1};
    entry.revision = 1;
    for (std::size_t i = 0; i < sensors; ++i) {
      sensing::SensorInfo info;
      info.sensor_uid = SensorUid{i + 1};
      info.driver = "fake";
      info.label = "s" + std::to_string(i);
      description_.sensors.push_back(info);
      entry.sensors.push_back({info.sensor_uid, static_cast<body::Segment>(i)});
    }
    description_.bodies.push_back(entry);
  }

  DriverDescription& description() { return description_; }
  /// Given instead of the regular ticks, in their order.
  std::deque<Result<DriverStep>> steps;
  bool orientation_only = false;
  bool with_truth = false;
  std::function<void(Batch&)> extra;  ///< adds to every tick

  [[nodiscard]] const DriverDescription& Describe() const override { return description_; }

  std::vector<CoilSchedule> schedules;  ///< that it was told
  Status fits = Ok();                   ///< what it answers to them
  [[nodiscard]] Status FollowSlots(const CoilSchedule& schedule) override {
    schedules.push_back(schedule);
    return fits;
  }

  [[nodiscard]] Result<DriverStep> Next(Batch& batch) override {
    batch.Clear();
    if (!steps.empty()) {
      const Result<DriverStep> step = steps.front();
      steps.pop_front();
      if (!step || *step != DriverStep::kData) {
        return step;
      }
    } else if (next_ == ticks_) {
      return DriverStep::kEnd;
    }
    batch.tick_at = Time{std::chrono::milliseconds(10 * next_)};
    for (const sensing::SensorInfo& info : description_.sensors) {
      if (orientation_only) {
        sensing::FusedOrientation sample;
        sample.sensor_uid = info.sensor_uid;
        sample.measured_at = batch.tick_at;
        batch.orientation.push_back(sample);
        continue;
      }
      sensing::MargSample sample;
      sample.sensor_uid = info.sensor_uid;
      sample.measured_at = batch.tick_at;
      sample.flags = sensing::kMagMissing;
      sample.accel_m_s2.z() = 9.81F;
      batch.marg.push_back(sample);
    }
    if (with_truth) {
      body::SegmentTruth truth;
      truth.body_id = BodyId{1};
      truth.measured_at = batch.tick_at;
      batch.truth.push_back(truth);
    }
    if (extra) {
      extra(batch);
    }
    ++next_;
    return DriverStep::kData;
  }

  [[nodiscard]] Status Rewind() override {
    next_ = 0;
    return Ok();
  }

 private:
  DriverDescription description_;
  std::size_t ticks_;
  std::size_t next_ = 0;
};

}  // namespace limbcast::gateway::test
