#include "services/gateway/tick_source.hpp"

#include <string>
#include <utility>

#include "common/base/expects.hpp"

namespace limbcast::gateway {

namespace {

// Between the loops of a recording that states no rate.
constexpr Duration kFallbackPeriod = std::chrono::milliseconds(10);

Duration PeriodOf(const DriverDescription& description) {
  return description.tick_rate_hz > 0.0 ? DurationFromSeconds(1.0 / description.tick_rate_hz)
                                        : kFallbackPeriod;
}

}  // namespace

void Name(const std::string& person, std::vector<roster::RosterEntry>& bodies) {
  for (std::size_t i = 0; i < bodies.size() && !person.empty(); ++i) {
    bodies[i].person = i == 0 ? person : person + " " + std::to_string(i + 1);
  }
}

TickSource::TickSource(std::unique_ptr<Driver> driver, const GatewayConfig& config)
    : driver_(std::move(driver)),
      description_(driver_->Describe()),
      loop_(config.loop),
      period_(PeriodOf(description_)),
      stream_clock_(config.pace) {
  Expects(
      config.granted_bodies.empty() || config.granted_bodies.size() == description_.bodies.size(),
      "a granted body id for each body, or none");
  for (std::size_t i = 0; i < config.granted_bodies.size(); ++i) {
    granted_.emplace(description_.bodies[i].body_id, config.granted_bodies[i]);
  }
  if (config.body_id != 0) {
    const std::uint32_t first =
        description_.bodies.empty() ? 1U : description_.bodies.front().body_id.value;
    body_id_offset_ = std::int64_t{config.body_id} - first;
  }
  for (roster::RosterEntry& entry : description_.bodies) {
    entry.body_id = Renumbered(entry.body_id);
    entry.session = config.session;
  }
  Name(config.person, description_.bodies);
}

BodyId TickSource::Renumbered(BodyId body) const {
  if (const auto granted = granted_.find(body); granted != granted_.end()) {
    return granted->second;
  }
  return {static_cast<std::uint32_t>(std::int64_t{body.value} + body_id_offset_)};
}

// The next tick of the driver, over the end of a loop.
Result<DriverStep> TickSource::Next() {
  Result<DriverStep> step = driver_->Next(batch_);
  const bool again = step && *step == DriverStep::kEnd && loop_ && first_tick_at_;
  if (!again) {
    return step;
  }
  if (const Status rewound = driver_->Rewind(); !rewound) {
    return rewound.error();
  }
  stream_clock_.Loop(*first_tick_at_, period_);
  last_tick_at_ = *first_tick_at_ - period_;
  ++loops_;
  return driver_->Next(batch_);
}

Status TickSource::FollowSlots(std::shared_ptr<const CoilSchedule> schedule, Time start_at) {
  Duration to_host{};
  if (!live()) {
    // A recording's first tick is at about zero.
    to_host = (first_tick_at_ ? stream_clock_.ToStream(Time{}) : start_at).time_since_epoch();
  }
  if (schedule == schedule_ && to_host == scheduled_to_host_) {
    return Ok();
  }
  schedule_ = std::move(schedule);
  scheduled_to_host_ = to_host;
  CoilSchedule drivers{.own = {}, .foreign = schedule_->foreign, .to_host = to_host};
  for (const roster::RosterEntry& body : driver_->Describe().bodies) {
    drivers.own.push_back(
        {.body_id = body.body_id, .grant = schedule_->Of(Renumbered(body.body_id))});
  }
  return driver_->FollowSlots(drivers);
}

Result<DriverStep> TickSource::Load(Time start_at) {
  Expects(!loaded_, "one tick loaded at a time");
  Result<DriverStep> step = Next();
  loaded_ = step && *step == DriverStep::kData;
  if (loaded_ && !first_tick_at_) {
    first_tick_at_ = batch_.tick_at;
    stream_clock_.Start(batch_.tick_at, start_at);
  }
  return step;
}

Time TickSource::DueAt(Time now) const {
  return live() ? now : stream_clock_.DueAt(batch_.tick_at, now);
}

Time TickSource::DueInRealTime(Time now) const {
  return live() ? now : stream_clock_.DueInRealTime(batch_.tick_at);
}

void TickSource::MapToHost(Time now) {
  jumped_ = stream_clock_.Send(batch_.tick_at, now);
  for (sensing::MargSample& sample : batch_.marg) {
    sample.measured_at = stream_clock_.ToStream(sample.measured_at);
  }
  for (sensing::FusedOrientation& sample : batch_.orientation) {
    sample.measured_at = stream_clock_.ToStream(sample.measured_at);
  }
  for (sensing::MarkerPosition& marker : batch_.markers) {
    marker.measured_at = stream_clock_.ToStream(marker.measured_at);
  }
  for (sensing::CoilBurst& burst : batch_.coil_bursts) {
    burst.measured_at = stream_clock_.ToStream(burst.measured_at);
    for (sensing::CoilPulse& pulse : burst.pulses) {
      if (pulse.off_at != Time{}) {  // else there has been none
        pulse.on_at = stream_clock_.ToStream(pulse.on_at);
        pulse.off_at = stream_clock_.ToStream(pulse.off_at);
      }
    }
  }
  for (body::SegmentTruth& truth : batch_.truth) {
    truth.measured_at = stream_clock_.ToStream(truth.measured_at);
  }
}

Batch& TickSource::Take(Time now) {
  Expects(loaded_, "a loaded tick");
  loaded_ = false;
  streamed_ += last_tick_at_ ? batch_.tick_at - *last_tick_at_ : Duration{};
  last_tick_at_ = batch_.tick_at;
  if (!live()) {
    MapToHost(now);
  }
  for (body::SegmentTruth& truth : batch_.truth) {
    truth.body_id = Renumbered(truth.body_id);
  }
  for (sensing::MarkerPosition& marker : batch_.markers) {
    marker.body_id = Renumbered(marker.body_id);
  }
  return batch_;
}

}  // namespace limbcast::gateway
