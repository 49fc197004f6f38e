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
constexpr Duration kRetryPause = 1s;  // before a failed device is asked again
}  // namespace

GatewayService::GatewayService(GatewayConfig config, std::unique_ptr<Driver> driver,
                               const Clock& clock, bus::Bus& bus, runtime::WorkerPool& pool,
                               std::function<void()> on_end)
    : config_(std::move(config)),
      clock_(clock),
      bus_(bus),
      pool_(pool),
      on_end_(std::move(on_end)),
      source_(std::move(driver), config_) {
  summary_.driver = source_.description().driver;
  summary_.source = source_.description().source;
  summary_.bodies = static_cast<std::uint32_t>(source_.description().bodies.size());
  summary_.sensors = static_cast<std::uint32_t>(source_.description().sensors.size());
}

Status GatewayService::Start() {
  Expects(!started_, "a service is started once");
  auto publisher = SamplePublisher::Make(config_, source_.description(), clock_, bus_);
  if (!publisher) {
    return publisher.error();
  }
  publisher_ = std::move(*publisher);
  flow_ = std::make_unique<FlowControl>(config_, source_.description());
  if (Status made = MakeReaders(); !made) {
    return made;
  }
  if (Status announced = publisher_->Announce(source_.description()); !announced) {
    return announced;
  }
  if (source_.description().bodies.empty() && config_.publish_roster && !config_.session_host) {
    spdlog::warn("{} says of no sensor where it is worn: fusion will not use them (see --assign)",
                 source_.description().source);
  }
  started_ = true;
  pool_.Start([this](std::size_t worker) { return worker == 0 ? Drain() : std::nullopt; });
  return Ok();
}

Status GatewayService::MakeReaders() {
  if (!source_.description().coil_sources.empty()) {
    std::vector<BodyId> own;
    for (const roster::RosterEntry& body : source_.description().bodies) {
      own.push_back(body.body_id);
    }
    auto grants = CoilGrants::Make(bus_, std::move(own));
    if (!grants) {
      return grants.error();
    }
    grants_ = std::move(*grants);
  }
  if (FlowControl::NeedsStates(config_)) {
    auto reader = bus::SegmentStateReader::Make(
        bus_, [this](std::span<const body::SegmentState> states, const bus::SampleInfo&) {
          bool wake = false;
          for (const body::SegmentState& state : states) {
            wake = flow_->OnState(state) || wake;
          }
          if (wake) {
            pool_.Wake(0);
          }
        });
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
  source_.Interrupt();
  pool_.Stop();
  stopped_ = true;
  state_reader_.reset();
  skeleton_reader_.reset();
  grants_.reset();
  publisher_->Withdraw(source_.description());
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
  if (!flow_->needs_answers()) {
    // The way is open. Going on listening would cost fusion one more send for every sample.
    state_reader_.reset();
    skeleton_reader_.reset();
  }
  while (!stopping_) {
    const Time now = clock_.Now();
    if (!source_.loaded()) {
      const std::optional<Time> again = LoadTick(now);
      if (!source_.loaded()) {
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

// Nothing when a tick is loaded, else when to be called again (nothing = never).
std::optional<Time> GatewayService::LoadTick(Time now) {
  if (now < retry_at_) {
    return retry_at_;
  }
  // Later than every probe, or the first samples would count as old.
  const Time start_at = std::max(now, last_probe_at_ + 1ms);
  if (grants_ != nullptr) {
    if (const Status fits = source_.FollowSlots(grants_->schedule(), start_at); !fits) {
      spdlog::warn("{}", fits.error().message);
      SetLastError(fits.error().message);
    }
  }
  const Result<DriverStep> step = source_.Load(start_at);
  if (step) {
    if (*step == DriverStep::kEnd) {
      EndOfData(now);
    }
    return now;
  }
  if (source_.live()) {
    spdlog::warn("{}: {}", source_.description().source, step.error().message);
    SetLastError(step.error().message);
    retry_at_ = now + kRetryPause;
    return retry_at_;
  }
  Fail(step.error());
  return std::nullopt;
}

// When the loaded tick may be sent; nothing = now.
std::optional<Time> GatewayService::NotYet(Time now) {
  Time due = source_.DueAt(now);
  if (config_.pace.as_fast && !source_.live()) {
    if (!flow_->link_lost(now)) {
      return flow_->Full(now);
    }
    due = source_.DueInRealTime(now);
  }
  return due > now ? std::optional(due) : std::nullopt;
}

void GatewayService::SendTick(Time now) {
  Batch& batch = source_.Take(now);
  publisher_->Stamp(batch);
  flow_->Sent(batch, publisher_->streams(), publisher_->marg_streams(),
              publisher_->orientation_streams(), now);
  publisher_->Write(batch);
  lag_.Record(source_.lag());
  burst_.Record(clock_.Now() - now);

  const std::scoped_lock lock(mutex_);
  if (publisher_->counters().write_errors != summary_.published.write_errors) {
    summary_.error = publisher_->last_error();
  }
  summary_.published = publisher_->counters();
  summary_.device_lost += batch.device_lost;
  summary_.loops = source_.loops();
  summary_.time_jumps += source_.jumped() ? 1U : 0U;
  summary_.max_lag_ms = std::max(summary_.max_lag_ms, 1e3 * ToSeconds(source_.lag()));
  summary_.stream_s = ToSeconds(source_.streamed());
  first_sent_at_ = first_sent_at_.value_or(now);
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
  if (stopped_) {  // else the worker is writing to its streams
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
  AddValues(summary, health);
  health.values.push_back({"gauge.phase", static_cast<double>(phase())});
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
