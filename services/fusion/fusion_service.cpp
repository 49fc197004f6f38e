#include "services/fusion/fusion_service.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "common/base/expects.hpp"

namespace limbcast::fusion {

namespace {

constexpr std::size_t kMaxWorkers = 64;  // one bit each in `touched`
constexpr std::size_t kMaxReplyLength = 255;

}  // namespace

FusionService::FusionService(FusionConfig config, const Clock& clock, bus::Bus& bus,
                             runtime::WorkerPool& pool, FilterFactory factory)
    : config_(std::move(config)),
      factory_(factory ? std::move(factory) : MakeFilterFactory(config_)),
      clock_(clock),
      bus_(bus),
      pool_(pool),
      router_(config_, pool.size()),
      store_(config_.state_dir, FilterSettingsNumber(config_)),
      keeper_(
          store_, clock_, pool.size(),
          [this](std::size_t worker, std::shared_ptr<FilterSnapshot> snapshot) {
            const bool room = workers_[worker]->Offer(std::move(snapshot));
            pool_.Wake(worker);
            return room;
          },
          [this](const Status& written) {
            if (!written) {
              SetLastError(written.error().message);
            }
          }) {
  Expects(pool_.size() <= kMaxWorkers, "at most 64 workers");
}

template <typename T>
Status FusionService::Listen(std::unique_ptr<bus::Reader<T>>& reader,
                             bus::ReaderHandler<T> handler) {
  Result<std::unique_ptr<bus::Reader<T>>> made = bus_.MakeReader<T>(std::move(handler));
  if (!made) {
    return made.error();
  }
  reader = std::move(*made);
  return Ok();
}

Status FusionService::Start() {
  Expects(!started_, "a service is started once");
  started_ = true;
  if (Status taken = TakeUpFilters(); !taken) {
    return taken;
  }
  auto state_writers = StateWriters::Make(bus_, config_.segment_frame);
  if (!state_writers) {
    return state_writers.error();
  }
  state_writers_ = std::move(*state_writers);
  auto reply_writer = bus_.MakeWriter<roster::CommandReply>();
  if (!reply_writer) {
    return reply_writer.error();
  }
  reply_writer_ = std::move(*reply_writer);
  for (std::size_t i = 0; i < pool_.size(); ++i) {
    workers_.push_back(std::make_unique<FusionWorker>(config_, factory_, clock_, state_writers_,
                                                      latencies_, saved_filters_));
  }
  pool_.Start([this](std::size_t worker) -> std::optional<Time> {
    workers_[worker]->Drain();
    return std::nullopt;
  });
  if (store_.keeps()) {
    keeper_.Start(DurationFromSeconds(config_.state_period_s));
  }
  return MakeReaders();
}

// Without them everything works, so a damaged file is only told of.
Status FusionService::TakeUpFilters() {
  if (Status prepared = store_.Prepare(); !prepared) {
    return prepared;
  }
  const Duration max_age = DurationFromSeconds(config_.state_max_age_s);
  if (const Status loaded = store_.Load(clock_.Now(), max_age, saved_filters_); !loaded) {
    SetLastError(loaded.error().message);
  }
  return Ok();
}

// What the filters know at the end; with the pool stopped.
void FusionService::KeepFilters() {
  std::vector<std::shared_ptr<FilterSnapshot>> snapshots;
  for (const auto& worker : workers_) {
    snapshots.push_back(std::make_shared<FilterSnapshot>());
    worker->SaveFilters(*snapshots.back());
  }
  keeper_.SaveNow(std::move(snapshots));
}

Status FusionService::MakeReaders() {
  using bus::SampleInfo;
  // Who is who comes first, so that samples find it.
  Status made = Listen<roster::RosterEntry>(
      roster_reader_, {.on_sample =
                           [this](const roster::RosterEntry& entry, const SampleInfo&) {
                             std::unique_lock lock(intake_mutex_);
                             const std::uint64_t touched = HandOver(router_.Apply(entry));
                             lock.unlock();
                             Wake(touched);
                           },
                       .on_disposed =
                           [this](const roster::RosterEntry& entry) {
                             std::unique_lock lock(intake_mutex_);
                             const std::uint64_t touched = HandOver(router_.Remove(entry.body_id));
                             lock.unlock();
                             Wake(touched);
                           }});
  if (made) {
    made = Listen<sensing::SensorInfo>(
        sensor_info_reader_, {.on_sample =
                                  [this](const sensing::SensorInfo& info, const SampleInfo&) {
                                    const std::scoped_lock lock(intake_mutex_);
                                    announced_.insert(info.sensor_uid);
                                  },
                              .on_disposed =
                                  [this](const sensing::SensorInfo& info) {
                                    const std::scoped_lock lock(intake_mutex_);
                                    announced_.erase(info.sensor_uid);
                                  }});
  }
  if (made) {
    made = Listen<roster::Command>(command_reader_,
                                   {.on_sample = [this](const roster::Command& command,
                                                        const SampleInfo&) { OnCommand(command); },
                                    .on_disposed = {}});
  }
  if (made && !config_.position.markers.segments.empty()) {
    // Before the samples: a marker waits for the reading of its time, not the other way round.
    made = Listen<sensing::MarkerPosition>(
        marker_reader_,
        {.on_sample = [this](const sensing::MarkerPosition& marker,
                             const SampleInfo& info) { OnMarker(marker, info.received_at); },
         .on_disposed = {}});
  }
  if (made) {
    made = Listen<sensing::MargSample>(
        marg_reader_,
        {.on_sample = [this](const sensing::MargSample& sample,
                             const SampleInfo& info) { OnSample(sample, info.received_at); },
         .on_disposed = {}});
  }
  if (made) {
    made = Listen<sensing::MargFrame>(
        marg_frame_reader_,
        {.on_sample = [this](const sensing::MargFrame& frame,
                             const SampleInfo& info) { OnFrame(frame, info.received_at); },
         .on_disposed = {}});
  }
  if (made) {
    made = Listen<sensing::FusedOrientation>(
        orientation_reader_,
        {.on_sample = [this](const sensing::FusedOrientation& orientation,
                             const SampleInfo& info) { OnSample(orientation, info.received_at); },
         .on_disposed = {}});
  }
  return made;
}

void FusionService::Stop() {
  keeper_.Stop();
  const std::scoped_lock lock(endpoints_mutex_);
  const bool running = roster_reader_ != nullptr;
  roster_reader_.reset();
  command_reader_.reset();
  marg_reader_.reset();
  marg_frame_reader_.reset();
  orientation_reader_.reset();
  marker_reader_.reset();
  sensor_info_reader_.reset();
  if (started_) {
    pool_.Stop();
  }
  if (running && store_.keeps()) {
    KeepFilters();
  }
}

// Queues one sample for its worker; gives the worker's bit, or 0 when there is nothing to wake.
// With intake_mutex_ held.
template <typename Sample>
std::uint64_t FusionService::Take(const Sample& sample, Time received_at) {
  Router::Route* const route = router_.Find(sample.sensor_uid);
  if (route == nullptr) {
    if ((sample.flags & sensing::MargFlag::kProbe) != 0) {
      intake_counters_.AddProbe();
    } else {
      intake_counters_.Add(SampleVerdict::kRejectedUnassigned);
    }
    return 0;
  }
  const Reception reception{.received_at = received_at, .overloads = route->overloads};
  if (!workers_[route->worker]->Offer(sample, reception)) {
    ++route->overloads;
    intake_counters_.Add(SampleVerdict::kRejectedOverload);
  }
  return std::uint64_t{1} << route->worker;
}

template <typename Sample>
void FusionService::OnSample(const Sample& sample, Time received_at) {
  std::unique_lock lock(intake_mutex_);
  const std::uint64_t touched = Take(sample, received_at);
  lock.unlock();
  Wake(touched);
}

// The samples that follow wake the worker. One that finds the queue full is as good as hidden.
void FusionService::OnMarker(const sensing::MarkerPosition& marker, Time received_at) {
  const std::scoped_lock lock(intake_mutex_);
  const Reception reception{.received_at = received_at};
  if (!workers_[router_.WorkerOf(marker.body_id)]->Offer(marker, reception)) {
    last_error_ = fmt::format("a marker of body {} was dropped: the queue of its worker is full",
                              marker.body_id.value);
  }
}

void FusionService::OnFrame(const sensing::MargFrame& frame, Time received_at) {
  std::uint64_t touched = 0;
  std::unique_lock lock(intake_mutex_);
  for (const sensing::MargSample& sample : frame.samples) {
    touched |= Take(sample, received_at);
  }
  lock.unlock();
  Wake(touched);
}

void FusionService::Wake(std::uint64_t touched) {
  for (std::size_t worker = 0; touched != 0; ++worker, touched >>= 1U) {
    if ((touched & 1U) != 0) {
      pool_.Wake(worker);
    }
  }
}

// With intake_mutex_ held, so that plans and samples are queued in one order.
std::uint64_t FusionService::HandOver(std::vector<BodyPlan> plans) {
  std::uint64_t touched = 0;
  for (BodyPlan& plan : plans) {
    const BodyId body_id = plan.body_id;
    const std::size_t worker = router_.WorkerOf(body_id);
    if (!workers_[worker]->Offer(std::make_shared<const BodyPlan>(std::move(plan)))) {
      last_error_ = fmt::format("a change of body {} was lost: the queue of its worker is full",
                                body_id.value);
    }
    touched |= std::uint64_t{1} << worker;
  }
  return touched;
}

void FusionService::OnCommand(const roster::Command& command) {
  if (command.kind != roster::CommandKind::kSelectFilter) {
    return;  // for another service
  }
  if (const roster::CommandReply* before = answered_.Find(command)) {
    Answer(*before);  // the answer was lost, or is under way
    return;
  }
  std::uint64_t touched = 0;
  const Result<std::string> done = SelectFilter(command, touched);
  Wake(touched);
  roster::CommandReply reply;
  reply.client_uid = command.client_uid;
  reply.request_id = command.request_id;
  reply.accepted = done.ok();
  reply.message = done.ok() ? *done : done.error().message;
  reply.message.resize(std::min(reply.message.size(), kMaxReplyLength));
  answered_.Add(reply);
  Answer(reply);
}

void FusionService::Answer(const roster::CommandReply& reply) {
  if (const Status written = reply_writer_->Write(reply); !written) {
    SetLastError(written.error().message);
  }
  reply_writer_->Flush();
}

Result<std::string> FusionService::SelectFilter(const roster::Command& command,
                                                std::uint64_t& touched) {
  constexpr std::string_view kBeside = "beside ";
  std::string name = command.text;
  std::uint8_t slot = 0;
  if (name.starts_with(kBeside)) {
    name.erase(0, kBeside.size());
    slot = 1;
    if (name == "none") {
      name.clear();
    }
  }
  if (slot == 0 || !name.empty()) {
    if (const auto made = factory_(name); !made) {
      return made.error();
    }
  }
  std::vector<body::Segment> segments;
  for (const double number : command.numbers) {
    if (!(number >= 0.0 && number < static_cast<double>(body::kSegmentCount)) ||
        number != std::floor(number)) {
      return Error{ErrorCode::kInvalidArgument,
                   fmt::format("segment must be a whole number in [0, {}], is {}",
                               body::kSegmentCount - 1, number)};
    }
    segments.push_back(static_cast<body::Segment>(number));
  }
  const std::scoped_lock lock(intake_mutex_);
  Result<std::vector<BodyPlan>> plans = router_.Select(command.body_id, segments, slot, name);
  if (!plans) {
    return plans.error();
  }
  const std::size_t bodies = plans->size();
  touched = HandOver(std::move(*plans));
  return fmt::format(
      "filter {}{} on {} of {} bodies", slot == 0 ? "" : "beside ", name.empty() ? "none" : name,
      segments.empty() ? "all segments" : fmt::format("{} segments", segments.size()), bodies);
}

void FusionService::SetLastError(const std::string& message) {
  const std::scoped_lock lock(intake_mutex_);
  last_error_ = message;
}

FusionCounters FusionService::counters() const {
  FusionCounters sum;
  intake_counters_.AddTo(sum);
  for (const auto& worker : workers_) {
    worker->counters().AddTo(sum);
  }
  return sum;
}

void FusionService::FillHealth(ServiceHealth& health) {
  const FusionCounters sum = counters();
  const auto add = [&health](std::string name, auto value) {
    health.values.push_back({std::move(name), static_cast<double>(value)});
  };
  add("samples.received", sum.received);
  add("samples.used", sum.verdicts.used());
  add("samples.lost", sum.lost);
  add("samples.probes", sum.probes);
  for (std::size_t i = 0; i < kSampleVerdictCount; ++i) {
    add("verdict." + std::string(ToString(static_cast<SampleVerdict>(i))), sum.verdicts.count[i]);
  }
  add("states.published", sum.published);
  add("states.errors", sum.publish_errors);
  add("states.with_position", sum.positions);
  add("filters.restored", sum.restored);
  add("filters.saved", keeper_.saved());
  add("filters.save_errors", keeper_.errors());
  add("gauge.queue_high_water", sum.queue_high_water);
  {
    const std::scoped_lock lock(endpoints_mutex_);
    const auto writers_of = [](const auto& reader) {
      return reader == nullptr ? 0 : reader->counters().alive_writers;
    };
    add("gauge.marg_writers", writers_of(marg_reader_));
    add("gauge.marg_frame_writers", writers_of(marg_frame_reader_));
    add("gauge.state_readers", state_writers_.readers());
  }
  {
    const std::scoped_lock lock(intake_mutex_);
    add("gauge.bodies", router_.body_count());
    add("gauge.sensors", router_.sensor_count());
    add("gauge.sensors_announced", announced_.size());
    add("roster.refused", router_.refused_assignments());
    if (health.last_error.empty()) {
      health.last_error = last_error_;
    }
  }
  health.latencies.push_back(latencies_.gateway_to_fusion.Take("gateway_to_fusion"));
  health.latencies.push_back(latencies_.queue.Take("fusion_queue"));
  health.latencies.push_back(latencies_.step.Take("fusion_step"));
  health.latencies.push_back(latencies_.fusion.Take("fusion"));
}

}  // namespace limbcast::fusion
