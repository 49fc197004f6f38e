#include "services/gateway/gateway_service.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "common/base/expects.hpp"

namespace limbcast::gateway {

namespace {

using namespace std::chrono_literals;

constexpr Duration kProbePeriod = 100ms;
constexpr Duration kRetryPause = 1s;        // before a failed device is asked again
constexpr Duration kFallbackPeriod = 10ms;  // between the loops of a recording that states no rate

Duration PeriodOf(const DriverDescription& description) {
  return description.tick_rate_hz > 0.0 ? DurationFromSeconds(1.0 / description.tick_rate_hz)
                                        : kFallbackPeriod;
}

}  // namespace

GatewayService::GatewayService(GatewayConfig config, std::unique_ptr<Driver> driver,
                               const Clock& clock, bus::Bus& bus, runtime::WorkerPool& pool,
                               std::function<void()> on_end)
    : config_(std::move(config)),
      driver_(std::move(driver)),
      description_(driver_->Describe()),
      clock_(clock),
      bus_(bus),
      pool_(pool),
      on_end_(std::move(on_end)),
      stream_clock_(config_.pace),
      tick_period_(PeriodOf(description_)) {
  if (config_.body_id != 0) {
    const std::uint32_t first =
        description_.bodies.empty() ? 1U : description_.bodies.front().body_id.value;
    body_id_offset_ = std::int64_t{config_.body_id} - first;
  }
  for (roster::RosterEntry& entry : description_.bodies) {
    entry.body_id = Shifted(entry.body_id);
    entry.session = config_.session;
  }
  summary_.driver = description_.driver;
  summary_.source = description_.source;
  summary_.bodies = static_cast<std::uint32_t>(description_.bodies.size());
  summary_.sensors = static_cast<std::uint32_t>(description_.sensors.size());
}

BodyId GatewayService::Shifted(BodyId body) const {
  return {static_cast<std::uint32_t>(std::int64_t{body.value} + body_id_offset_)};
}

Status GatewayService::Start() {
  Expects(!started_, "a service is started once");
  auto publisher = SamplePublisher::Make(config_, description_, clock_, bus_);
  if (!publisher) {
    return publisher.error();
  }
  publisher_ = std::move(*publisher);
  flow_ = std::make_unique<FlowControl>(config_, description_);
  if (Status made = MakeReaders(); !made) {
    return made;
  }
  if (Status announced = publisher_->Announce(description_); !announced) {
    return announced;
  }
  if (description_.bodies.empty() && config_.publish_roster) {
    spdlog::warn("{} says of no sensor where it is worn: fusion will not use them (see --assign)",
                 description_.source);
  }
  started_ = true;
  pool_.Start([this](std::size_t worker) { return worker == 0 ? Drain() : std::nullopt; });
  return Ok();
}

Status GatewayService::MakeReaders() {
  if (FlowControl::NeedsStates(config_)) {
    auto reader = bus_.MakeReader<body::SegmentState>(
        {.on_sample =
             [this](const body::SegmentState& state, const bus::SampleInfo&) {
               if (flow_->OnState(state)) {
                 pool_.Wake(0);
               }
             },
         .on_disposed = {}});
    if (!reader) {
      return reader.error();
    }
    state_reader_ = std::move(*reader);
  }
  if (FlowControl::NeedsSkeletons(config_)) {
    auto reader = bus_.MakeReader<body::Skeleton>(
        {.on_sample =
             [this](const body::Skeleton& skeleton, const bus::SampleInfo&) {
               if (flow_->OnSkeleton(skeleton)) {
                 pool_.Wake(0);
               }
             },
         .on_disposed = {}});
    if (!reader) {
      return reader.error();
    }
    skeleton_reader_ = std::move(*reader);
  }
  return Ok();
}

void GatewayService::Stop() {
  if (!started_ || stopping_.exchange(true)) {
    return;
  }
  driver_->Interrupt();
  pool_.Stop();
  state_reader_.reset();
  skeleton_reader_.reset();
  publisher_->Withdraw(description_);
  const std::scoped_lock lock(mutex_);
  if (phase_ != Phase::kEnded) {
    summary_.end = "stopped";
  }
}

GatewayService::Phase GatewayService::phase() const {
  const std::scoped_lock lock(mutex_);
  return phase_;
}

void GatewayService::SetPhase(Phase phase) {
  const std::scoped_lock lock(mutex_);
  phase_ = phase;
}

void GatewayService::SetLastError(const std::string& message) {
  const std::scoped_lock lock(mutex_);
  summary_.error = message;
}

bool GatewayService::ended() const { return phase() == Phase::kEnded; }

Status GatewayService::result() const {
  const std::scoped_lock lock(mutex_);
  return failure_ ? Status(*failure_) : Ok();
}

// Returns when to be called next; `now` after a change of phase.
std::optional<Time> GatewayService::Drain() {
  if (stopping_) {
    return std::nullopt;
  }
  const Time now = clock_.Now();
  switch (phase()) {
    case Phase::kWaiting:
      return Wait(now);
    case Phase::kStreaming:
      return Stream();
    case Phase::kLingering:
      return Linger(now);
    case Phase::kEnded:
      return std::nullopt;
  }
  return std::nullopt;
}

std::optional<Time> GatewayService::Wait(Time now) {
  if (!FlowControl::NeedsStates(config_)) {
    BeginStreaming(now);
    return now;
  }
  if (!waiting_since_) {
    waiting_since_ = now;
    next_probe_at_ = now;
    flow_->StartProbing(now);
  }
  if (flow_->WayOpen() && publisher_->HasReaders()) {
    BeginStreaming(now);
    return now;
  }
  const Time give_up_at = *waiting_since_ + DurationFromSeconds(config_.wait_timeout_s);
  if (now >= give_up_at) {
    const std::string missing = flow_->Missing();
    const Error error{
        ErrorCode::kTimeout,
        fmt::format("no way through the pipeline within {} s ({})", config_.wait_timeout_s,
                    missing.empty() ? "no reader of the samples" : missing)};
    {
      const std::scoped_lock lock(mutex_);
      summary_.wait_timed_out = true;
    }
    if (config_.exit_on_wait_timeout) {
      Fail(error);
      return std::nullopt;
    }
    spdlog::warn("{}; starting all the same", error.message);
    SetLastError(error.message);
    flow_->LoseLink(now);
    BeginStreaming(now);
    return now;
  }
  if (now >= next_probe_at_) {
    publisher_->WriteProbes(now);
    next_probe_at_ = now + kProbePeriod;
    last_probe_at_ = now;
  }
  return std::min(next_probe_at_, give_up_at);
}

void GatewayService::BeginStreaming(Time now) {
  flow_->StopProbing();
  const std::scoped_lock lock(mutex_);
  phase_ = Phase::kStreaming;
  summary_.waited_s = waiting_since_ ? ToSeconds(now - *waiting_since_) : 0.0;
}

std::optional<Time> GatewayService::Stream() {
  while (!stopping_) {
    const Time now = clock_.Now();
    if (!batch_loaded_) {
      const std::optional<Time> again = LoadTick(now);
      if (!batch_loaded_) {
        return again;
      }
    }
    if (const std::optional<Time> at = NotYet(now)) {
      return at;
    }
    SendTick(now);
  }
  return std::nullopt;
}

// The next tick of the driver, over the end of a loop.
Result<DriverStep> GatewayService::NextTick() {
  Result<DriverStep> step = driver_->Next(batch_);
  const bool again = step && *step == DriverStep::kEnd && config_.loop && first_tick_at_;
  if (!again) {
    return step;
  }
  if (const Status rewound = driver_->Rewind(); !rewound) {
    return rewound.error();
  }
  stream_clock_.Loop(*first_tick_at_, tick_period_);
  {
    const std::scoped_lock lock(mutex_);
    ++summary_.loops;
  }
  return driver_->Next(batch_);
}

std::optional<Time> GatewayService::LoadTick(Time now) {
  if (now < retry_at_) {
    return retry_at_;
  }
  const Result<DriverStep> step = NextTick();
  if (!step && description_.time == DriverTime::kHost) {
    spdlog::warn("{}: {}", description_.source, step.error().message);
    SetLastError(step.error().message);
    retry_at_ = now + kRetryPause;
    return retry_at_;
  }
  if (!step) {
    Fail(step.error());
    return std::nullopt;
  }
  switch (*step) {
    case DriverStep::kWaiting:
      return now;
    case DriverStep::kEnd:
      EndOfData(now);
      return now;
    case DriverStep::kData:
      batch_loaded_ = true;
      break;
  }
  if (!stream_started_) {
    stream_started_ = true;
    first_tick_at_ = batch_.tick_at;
    // Later than every probe, or the first samples would count as old.
    stream_clock_.Start(batch_.tick_at, std::max(now, last_probe_at_ + 1ms));
  }
  return std::nullopt;
}

// When the loaded tick may be sent; nothing = now.
std::optional<Time> GatewayService::NotYet(Time now) {
  if (description_.time == DriverTime::kHost) {
    return std::nullopt;
  }
  if (config_.pace.as_fast && !flow_->link_lost(now)) {
    return flow_->Full(now);
  }
  const Time due = config_.pace.as_fast ? stream_clock_.DueInRealTime(batch_.tick_at)
                                        : stream_clock_.DueAt(batch_.tick_at, now);
  return due > now ? std::optional(due) : std::nullopt;
}

// Times of the loaded tick from the recording's scale to the host's.
void GatewayService::MapToHost(Time now) {
  const bool jumped = stream_clock_.Send(batch_.tick_at, now);
  lag_.Record(stream_clock_.lag());
  for (sensing::MargSample& sample : batch_.marg) {
    sample.measured_at = stream_clock_.ToStream(sample.measured_at);
  }
  for (sensing::FusedOrientation& sample : batch_.orientation) {
    sample.measured_at = stream_clock_.ToStream(sample.measured_at);
  }
  for (body::SegmentTruth& truth : batch_.truth) {
    truth.measured_at = stream_clock_.ToStream(truth.measured_at);
  }
  const std::scoped_lock lock(mutex_);
  summary_.time_jumps += jumped ? 1U : 0U;
  summary_.max_lag_ms = std::max(summary_.max_lag_ms, 1e3 * ToSeconds(stream_clock_.lag()));
}

void GatewayService::SendTick(Time now) {
  const Time tick_at = batch_.tick_at;
  if (description_.time == DriverTime::kRecording) {
    MapToHost(now);
  }
  for (body::SegmentTruth& truth : batch_.truth) {
    truth.body_id = Shifted(truth.body_id);
  }
  publisher_->Stamp(batch_);
  flow_->Sent(batch_, publisher_->streams(), publisher_->marg_streams(),
              publisher_->orientation_streams(), now);
  publisher_->Write(batch_);
  burst_.Record(clock_.Now() - now);
  batch_loaded_ = false;

  const std::scoped_lock lock(mutex_);
  first_sent_at_ = first_sent_at_.value_or(now);
  if (publisher_->counters().write_errors != summary_.published.write_errors) {
    summary_.error = publisher_->last_error();
  }
  if (summary_.ticks > 0 && tick_at > last_tick_at_) {
    summary_.stream_s += ToSeconds(tick_at - last_tick_at_);
  }
  last_tick_at_ = tick_at;
  summary_.published = publisher_->counters();
  summary_.device_lost += batch_.device_lost;
  summary_.wall_s = ToSeconds(now - *first_sent_at_);
  ++summary_.ticks;
}

void GatewayService::EndOfData(Time now) {
  linger_until_ = now + DurationFromSeconds(config_.linger_s);
  SetPhase(Phase::kLingering);
}

std::optional<Time> GatewayService::Linger(Time now) {
  if (const std::optional<Time> later = flow_->Outstanding(now)) {
    return later;
  }
  if (now < *linger_until_) {
    return *linger_until_;
  }
  End("end_of_data");
  return std::nullopt;
}

void GatewayService::Fail(const Error& error) {
  spdlog::error("{}", error.message);
  {
    const std::scoped_lock lock(mutex_);
    failure_ = error;
    summary_.error = error.message;
  }
  End("failed");
}

void GatewayService::End(const char* how) {
  {
    const std::scoped_lock lock(mutex_);
    phase_ = Phase::kEnded;
    summary_.end = how;
  }
  if (on_end_ && (config_.exit_at_end || !result())) {
    on_end_();
  }
}

GatewaySummary GatewayService::Summary() const {
  GatewaySummary summary;
  {
    const std::scoped_lock lock(mutex_);
    summary = summary_;
  }
  if (!started_) {
    return summary;
  }
  const FlowControl::Counters flow = flow_->counters();
  summary.samples_unanswered = flow.samples_unanswered;
  summary.ticks_unanswered = flow.ticks_unanswered;
  summary.late_answers = flow.late_answers;
  summary.link_losses = flow.link_losses;
  if (stopping_) {  // else the worker is writing to its streams
    for (const SensorStream& stream : publisher_->streams()) {
      summary.by_sensor.push_back(
          {.label = stream.label,
           .published = std::uint64_t{stream.marg_sequence} + stream.orientation_sequence,
           .unanswered = flow_->unanswered(stream.uid)});
    }
  }
  return summary;
}

void GatewayService::FillHealth(ServiceHealth& health) {
  const GatewaySummary summary = Summary();
  const auto add = [&health](const char* name, auto value) {
    health.values.push_back({name, static_cast<double>(value)});
  };
  add("samples.published", summary.published.marg + summary.published.orientation);
  add("samples.marg", summary.published.marg);
  add("samples.orientation", summary.published.orientation);
  add("samples.truth", summary.published.truth);
  add("samples.saturated", summary.published.saturated);
  add("samples.mag_missing", summary.published.mag_missing);
  add("samples.device_lost", summary.device_lost);
  add("samples.unanswered", summary.samples_unanswered);
  add("samples.write_errors", summary.published.write_errors);
  add("ticks.published", summary.ticks);
  add("ticks.unanswered", summary.ticks_unanswered);
  add("loops", summary.loops);
  add("time_jumps", summary.time_jumps);
  add("link_losses", summary.link_losses);
  add("wait_timeouts", summary.wait_timed_out ? 1 : 0);
  add("gauge.sensors", summary.sensors);
  add("gauge.bodies", summary.bodies);
  add("gauge.phase", static_cast<int>(phase()));
  add("gauge.max_lag_ms", summary.max_lag_ms);
  if (health.last_error.empty()) {
    health.last_error = summary.error;
    if (started_ && phase() == Phase::kWaiting) {
      health.last_error = "waiting: " + flow_->Missing();
    } else if (started_ && flow_->counters().link_lost) {
      health.last_error = "fusion does not answer: going on in real time";
    }
  }
  health.latencies.push_back(lag_.Take("gateway_lag"));
  health.latencies.push_back(burst_.Take("gateway_burst"));
}

}  // namespace limbcast::gateway
