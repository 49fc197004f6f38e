#include "services/gateway/flow_control.hpp"

#include <algorithm>

namespace limbcast::gateway {

namespace {

std::vector<SensorUid> WornSensors(const GatewayConfig& config,
                                   const DriverDescription& description) {
  std::vector<SensorUid> sensors;
  if (!config.publish_roster) {
    return sensors;  // a session host says who wears what: we do not know
  }
  for (const roster::RosterEntry& entry : description.bodies) {
    for (const roster::SensorAssignment& assignment : entry.sensors) {
      sensors.push_back(assignment.sensor_uid);
    }
  }
  return sensors;
}

// Those that carry sensors.
std::vector<BodyId> Bodies(const GatewayConfig& config, const DriverDescription& description) {
  std::vector<BodyId> bodies;
  for (const roster::RosterEntry& entry : description.bodies) {
    if (config.publish_roster && !entry.sensors.empty()) {
      bodies.push_back(entry.body_id);
    }
  }
  return bodies;
}

}  // namespace

bool FlowControl::NeedsStates(const GatewayConfig& config) {
  return config.pace.as_fast || config.wait_for != WaitFor::kNone;
}

bool FlowControl::NeedsSkeletons(const GatewayConfig& config) {
  return config.wait_for == WaitFor::kPosture;
}

FlowControl::FlowControl(const GatewayConfig& config, const DriverDescription& description)
    : as_fast_(config.pace.as_fast && description.time == DriverTime::kRecording),
      by_posture_(config.wait_for == WaitFor::kPosture),
      probe_(config.pace.as_fast ? std::max(config.wait_for, WaitFor::kFusion) : config.wait_for,
             WornSensors(config, description), Bodies(config, description)),
      samples_(config.window_ticks, DurationFromSeconds(config.answer_timeout_s),
               AckWindow::Older::kLost),
      ticks_(config.window_ticks, DurationFromSeconds(config.answer_timeout_s),
             AckWindow::Older::kAnswered) {
  for (const SensorUid uid : WornSensors(config, description)) {
    LaneOf(uid, true);
  }
  for (const sensing::SensorInfo& info : description.sensors) {
    LaneOf(info.sensor_uid, false);
  }
  for (const roster::RosterEntry& entry : description.bodies) {
    body_lane_of_[entry.body_id] =
        ticks_.AddLane(by_posture_ && config.publish_roster && !entry.sensors.empty());
  }
  body_tick_.resize(description.bodies.size());
}

std::size_t FlowControl::LaneOf(SensorUid uid, bool expected) {
  const auto [entry, is_new] = lane_of_.try_emplace(uid, lane_of_.size());
  if (is_new) {
    has_marg_.push_back(false);
    samples_.AddLane(expected);
  }
  return entry->second;
}

void FlowControl::StartProbing(Time now) {
  const std::scoped_lock lock(mutex_);
  probe_.Start(now);
  probing_ = true;
}

void FlowControl::StopProbing() {
  const std::scoped_lock lock(mutex_);
  probing_ = false;
}

bool FlowControl::WayOpen() const {
  const std::scoped_lock lock(mutex_);
  return probe_.open();
}

std::string FlowControl::Missing() const {
  const std::scoped_lock lock(mutex_);
  return probe_.Missing();
}

bool FlowControl::TakeWakeUp() {
  if (probing_) {
    return probe_.open();
  }
  const bool wake = waiting_ && !samples_.full() && !ticks_.full();
  waiting_ = waiting_ && !wake;
  return wake;
}

bool FlowControl::OnState(const body::SegmentState& state) {
  const std::scoped_lock lock(mutex_);
  if (state.slot != 0) {
    return false;  // a filter run beside the one in use
  }
  if (probing_) {
    probe_.OnState(state.sensor_uid, state.measured_at);
  }
  const auto lane = lane_of_.find(state.sensor_uid);
  if (as_fast_ && lane != lane_of_.end()) {
    if (state.sequence == 0) {  // the answer to a probe
      samples_.Heard(lane->second);
    } else {
      samples_.Answered(lane->second, state.sequence);
    }
  }
  return TakeWakeUp();
}

bool FlowControl::OnSkeleton(const body::Skeleton& skeleton) {
  const std::scoped_lock lock(mutex_);
  if (probing_) {
    probe_.OnSkeleton(skeleton.body_id, skeleton.measured_at);
  }
  const auto lane = body_lane_of_.find(skeleton.body_id);
  if (as_fast_ && lane != body_lane_of_.end()) {
    ticks_.Answered(lane->second, ToNanoseconds(skeleton.measured_at));
  }
  return TakeWakeUp();
}

void FlowControl::Sent(const Batch& batch, const std::vector<SensorStream>& streams,
                       const std::vector<std::size_t>& marg_streams,
                       const std::vector<std::size_t>& orientation_streams, Time now) {
  if (!as_fast_) {
    return;
  }
  const std::scoped_lock lock(mutex_);
  std::fill(body_tick_.begin(), body_tick_.end(), Time::min());
  const auto note = [&](std::size_t stream, bool is_marg, std::uint32_t sequence,
                        Time measured_at) {
    const std::size_t lane = LaneOf(streams[stream].uid, false);
    has_marg_[lane] = has_marg_[lane] || is_marg;
    if (has_marg_[lane] == is_marg) {
      samples_.Sent(lane, sequence, now);
    }
    if (const std::int32_t body = streams[stream].body; body >= 0) {
      Time& newest = body_tick_[static_cast<std::size_t>(body)];
      newest = std::max(newest, measured_at);
    }
  };
  for (std::size_t i = 0; i < batch.marg.size(); ++i) {
    note(marg_streams[i], true, batch.marg[i].sequence, batch.marg[i].measured_at);
  }
  for (std::size_t i = 0; i < batch.orientation.size(); ++i) {
    note(orientation_streams[i], false, batch.orientation[i].sequence,
         batch.orientation[i].measured_at);
  }
  for (std::size_t body = 0; body < body_tick_.size(); ++body) {
    if (body_tick_[body] != Time::min()) {
      ticks_.Sent(body, ToNanoseconds(body_tick_[body]), now);
    }
  }
}

void FlowControl::Expire(Time now) {
  samples_.Expire(now);
  ticks_.Expire(now);
  const bool lost = samples_.silent();
  link_losses_ += lost && !link_lost_ ? 1U : 0U;
  link_lost_ = lost;
}

std::optional<Time> FlowControl::Full(Time now) {
  const std::scoped_lock lock(mutex_);
  Expire(now);
  waiting_ = samples_.full() || ticks_.full();
  if (!waiting_) {
    return std::nullopt;
  }
  const Time later = now + std::chrono::seconds(1);
  return std::min(samples_.NextDeadline().value_or(later), ticks_.NextDeadline().value_or(later));
}

std::optional<Time> FlowControl::Outstanding(Time now) {
  const std::scoped_lock lock(mutex_);
  Expire(now);
  if (samples_.empty() && ticks_.empty()) {
    return std::nullopt;
  }
  return now + std::chrono::milliseconds(5);
}

bool FlowControl::link_lost(Time now) {
  const std::scoped_lock lock(mutex_);
  Expire(now);
  return as_fast_ && link_lost_;
}

void FlowControl::LoseLink(Time now) {
  const std::scoped_lock lock(mutex_);
  samples_.Silence();
  ticks_.Silence();
  Expire(now);
}

FlowControl::Counters FlowControl::counters() const {
  const std::scoped_lock lock(mutex_);
  return {.samples_unanswered = samples_.lost(),
          .ticks_unanswered = ticks_.lost(),
          .late_answers = samples_.late(),
          .link_losses = link_losses_,
          .link_lost = as_fast_ && link_lost_};
}

std::uint64_t FlowControl::unanswered(SensorUid uid) const {
  const std::scoped_lock lock(mutex_);
  const auto lane = lane_of_.find(uid);
  return lane == lane_of_.end() ? 0 : samples_.lost(lane->second);
}

}  // namespace limbcast::gateway
