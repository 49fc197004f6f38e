#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "common/bus/inproc/inproc_bus.hpp"
#include "common/math/rotation.hpp"
#include "services/fusion/fusion_service.hpp"
#include "tests/support/fake_clock.hpp"
#include "tests/support/immediate_pool.hpp"

namespace limbcast::fusion {

inline FilterFactory CountingFilters();

/// A filter that tests can predict: the orientation turns by gyro_rad_s about x for each used
/// sample, whatever the time; `needed` samples to start. Judges numbers and time like a real one.
class CountingFilter final : public filters::OrientationFilter {
 public:
  explicit CountingFilter(std::string_view name, int needed = 1) : name_(name), needed_(needed) {}

  SampleVerdict Update(const sensing::MargSample& sample) override {
    if (!sample.gyro_rad_s.allFinite()) {
      return SampleVerdict::kRejectedNotFinite;
    }
    if ((sample.flags & sensing::MargFlag::kGyroMissing) != 0) {
      return SampleVerdict::kNoData;
    }
    if ((sample.flags & sensing::MargFlag::kGyroSaturated) != 0) {
      return SampleVerdict::kRejectedSaturated;
    }
    if (used_ > 0 && sample.measured_at == last_) {
      return SampleVerdict::kRejectedDuplicate;
    }
    if (used_ > 0 && sample.measured_at < last_ && ++old_ < 20) {
      return SampleVerdict::kRejectedOutOfOrder;
    }
    old_ = 0;
    last_ = sample.measured_at;
    ++used_;
    angle_rad_ += static_cast<double>(sample.gyro_rad_s.x());
    estimate_.started = used_ >= needed_;
    estimate_.q_earth_sensor = math::ExpSO3({angle_rad_, 0.0, 0.0});
    estimate_.w_earth_sensor_in_sensor_rad_s = sample.gyro_rad_s.cast<double>();
    if (!estimate_.started) {
      return SampleVerdict::kStarting;
    }
    const bool no_accel = (sample.flags & sensing::MargFlag::kAccelMissing) != 0;
    return no_accel ? SampleVerdict::kPredictedOnly : SampleVerdict::kFused;
  }
  const filters::FilterEstimate& estimate() const override { return estimate_; }
  void Reset() override { *this = CountingFilter(name_, needed_); }
  std::string_view name() const override { return name_; }
  std::size_t state_size_bytes() const override { return 0; }
  void SaveState(std::span<std::byte>) const override {}
  Status RestoreState(std::span<const std::byte>) override { return Ok(); }

 private:
  std::string_view name_;
  int needed_;
  int used_ = 0;
  int old_ = 0;
  double angle_rad_ = 0.0;
  Time last_{};
  filters::FilterEstimate estimate_;
};

/// "tqt" starts at once, "slow" after ten samples.
inline FilterFactory CountingFilters() {
  return [](std::string_view name) -> Result<std::unique_ptr<filters::OrientationFilter>> {
    if (name == "tqt") {
      return std::unique_ptr<filters::OrientationFilter>(std::make_unique<CountingFilter>("tqt"));
    }
    if (name == "slow") {
      return std::unique_ptr<filters::OrientationFilter>(
          std::make_unique<CountingFilter>("slow", 10));
    }
    return Error{ErrorCode::kInvalidArgument,
                 "filter must be one of tqt, slow, is " + std::string(name)};
  };
}

/// The settings as shipped, but for a filter that CountingFilters makes.
inline FusionConfig CountingConfig() {
  FusionConfig config;
  config.filter.name = "tqt";
  return config;
}

inline constexpr Duration kPeriod = std::chrono::milliseconds(10);

/// Everything a sender and a listener need beside the service. Thread-safe where the bus is.
class FusionWorld {
 public:
  FusionWorld()
      : hub(bus::inproc::MakeHub(&clock)),
        outside(bus::inproc::MakeBus(hub)),
        inside(bus::inproc::MakeBus(hub)),
        marg(*outside->MakeWriter<sensing::MargSample>()),
        frame(*outside->MakeWriter<sensing::MargFrame>()),
        orientation(*outside->MakeWriter<sensing::FusedOrientation>()),
        roster(*outside->MakeWriter<roster::RosterEntry>()),
        command(*outside->MakeWriter<roster::Command>()),
        states_reader(*outside->MakeReader<body::SegmentState>(
            {.on_sample =
                 [this](const body::SegmentState& state, const bus::SampleInfo&) {
                   const std::scoped_lock lock(mutex);
                   states.push_back(state);
                 },
             .on_disposed =
                 [this](const body::SegmentState& key) {
                   const std::scoped_lock lock(mutex);
                   disposed.emplace_back(key.segment, key.slot);
                 }})),
        replies_reader(*outside->MakeReader<roster::CommandReply>(
            {.on_sample = [this](const roster::CommandReply& reply,
                                 const bus::SampleInfo&) { replies.push_back(reply); },
             .on_disposed = {}})) {}

  void Assign(std::uint32_t body_id, std::vector<std::pair<std::uint64_t, body::Segment>> sensors) {
    roster::RosterEntry entry;
    entry.body_id = BodyId{body_id};
    for (const auto& [uid, segment] : sensors) {
      entry.sensors.push_back({SensorUid{uid}, segment});
    }
    EXPECT_TRUE(roster->Write(entry).ok());
  }

  /// Sample number `sequence` of a sensor that started at clock start, 10 ms apart.
  sensing::MargSample Sample(std::uint64_t uid, std::uint32_t sequence) const {
    sensing::MargSample sample;
    sample.sensor_uid = SensorUid{uid};
    sample.sequence = sequence;
    sample.measured_at = start + static_cast<std::int64_t>(sequence) * kPeriod;
    sample.published_at = sample.measured_at;
    sample.gyro_rad_s.x() = 0.01F;
    return sample;
  }
  void Send(const sensing::MargSample& sample) { EXPECT_TRUE(marg->Write(sample).ok()); }

  [[nodiscard]] const body::SegmentState& last() const { return states.back(); }

  test_support::FakeClock clock;
  const Time start = clock.Now();
  std::shared_ptr<bus::inproc::Hub> hub;
  std::unique_ptr<bus::Bus> outside;
  std::unique_ptr<bus::Bus> inside;
  std::mutex mutex;
  std::vector<body::SegmentState> states;
  std::vector<std::pair<body::Segment, std::uint8_t>> disposed;
  std::vector<roster::CommandReply> replies;
  std::unique_ptr<bus::Writer<sensing::MargSample>> marg;
  std::unique_ptr<bus::Writer<sensing::MargFrame>> frame;
  std::unique_ptr<bus::Writer<sensing::FusedOrientation>> orientation;
  std::unique_ptr<bus::Writer<roster::RosterEntry>> roster;
  std::unique_ptr<bus::Writer<roster::Command>> command;
  std::unique_ptr<bus::Reader<body::SegmentState>> states_reader;
  std::unique_ptr<bus::Reader<roster::CommandReply>> replies_reader;
};

}  // namespace limbcast::fusion
