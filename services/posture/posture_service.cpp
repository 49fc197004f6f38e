#include "services/posture/posture_service.hpp"

#include <spdlog/spdlog.h>

#include <optional>
#include <utility>

#include "common/base/expects.hpp"

namespace limbcast::posture {

PostureService::PostureService(PostureConfig config, const Clock& clock, bus::Bus& bus,
                               runtime::WorkerPool& pool)
    : config_(std::move(config)), clock_(clock), bus_(bus), pool_(pool), store_(config_.state_dir) {
  Expects(Validate(config_).ok(), "a valid PostureConfig");
}

Status PostureService::Start() {
  Expects(!started_, "a service is started once");
  if (Status prepared = store_.Prepare(); !prepared) {
    return prepared;
  }
  if (Status made = MakeWriters(); !made) {
    return made;
  }
  started_ = true;
  shared_ = std::make_unique<PostureShared>(
      PostureShared{.config = config_,
                    .clock = clock_,
                    .store = store_,
                    .skeletons = *skeleton_writer_,
                    .joint_angles = joint_angle_writer_.get(),
                    .definitions = *definition_writer_,
                    .replies = *reply_writer_,
                    .counters = counters_,
                    .latencies = latencies_,
                    .on_error = [this](const std::string& message) { SetLastError(message); }});
  for (std::size_t i = 0; i < pool_.size(); ++i) {
    workers_.push_back(std::make_unique<PostureWorker>(*shared_));
  }
  pool_.Start([this](std::size_t worker) { return workers_[worker]->Drain(); });
  return MakeReaders();
}

Status PostureService::MakeWriters() {
  auto skeletons = bus_.MakeWriter<body::Skeleton>();
  if (!skeletons) {
    return skeletons.error();
  }
  auto definitions = bus_.MakeWriter<body::BodyDefinition>();
  if (!definitions) {
    return definitions.error();
  }
  auto replies = bus_.MakeWriter<roster::CommandReply>();
  if (!replies) {
    return replies.error();
  }
  if (config_.joint_angles) {
    auto joint_angles = bus_.MakeWriter<body::JointAngleFrame>();
    if (!joint_angles) {
      return joint_angles.error();
    }
    joint_angle_writer_ = std::move(*joint_angles);
  }
  skeleton_writer_ = std::move(*skeletons);
  definition_writer_ = std::move(*definitions);
  reply_writer_ = std::move(*replies);
  return Ok();
}

template <typename T>
Status PostureService::Listen(std::unique_ptr<bus::Reader<T>>& reader,
                              bus::ReaderHandler<T> handler) {
  Result<std::unique_ptr<bus::Reader<T>>> made = bus_.MakeReader<T>(std::move(handler));
  if (!made) {
    return made.error();
  }
  reader = std::move(*made);
  return Ok();
}

Status PostureService::MakeReaders() {
  using bus::SampleInfo;
  // What a posture service before or beside this one has in force, then who is who, then states.
  Status made = Listen<body::BodyDefinition>(
      definition_reader_, {.on_sample =
                               [this](const body::BodyDefinition& definition, const SampleInfo&) {
                                 HandOver(definition.body_id,
                                          std::make_shared<const body::BodyDefinition>(definition));
                               },
                           .on_disposed = {}});
  if (made) {
    made = Listen<roster::RosterEntry>(
        roster_reader_, {.on_sample =
                             [this](const roster::RosterEntry& entry, const SampleInfo&) {
                               HandOver(entry.body_id,
                                        std::make_shared<const roster::RosterEntry>(entry));
                             },
                         .on_disposed =
                             [this](const roster::RosterEntry& entry) {
                               HandOver(entry.body_id, PostureWorker::Gone{entry.body_id});
                             }});
  }
  if (made) {
    made = Listen<roster::Command>(
        command_reader_, {.on_sample =
                              [this](const roster::Command& command, const SampleInfo&) {
                                if (IsForPosture(command.kind)) {
                                  HandOver(command.body_id,
                                           std::make_shared<const roster::Command>(command));
                                }
                              },
                          .on_disposed = {}});
  }
  if (made) {
    made = Listen<sensing::PositionFix>(
        fix_reader_, {.on_sample = [this](const sensing::PositionFix& fix,
                                          const SampleInfo&) { HandOver(fix.body_id, fix); },
                      .on_disposed = {}});
  }
  if (made) {
    auto states = bus::SegmentStateReader::Make(
        bus_, [this](std::span<const body::SegmentState> of_body, const SampleInfo& info) {
          OnStates(of_body, info.received_at);
        });
    if (!states) {
      return states.error();
    }
    state_reader_ = std::move(*states);
  }
  return made;
}

void PostureService::Stop() {
  roster_reader_.reset();
  definition_reader_.reset();
  command_reader_.reset();
  fix_reader_.reset();
  state_reader_.reset();
  if (started_) {
    pool_.Stop();
  }
}

std::size_t PostureService::WorkerOf(BodyId body_id) const {
  return body_id.value % workers_.size();
}

void PostureService::OnStates(std::span<const body::SegmentState> states, Time received_at) {
  std::optional<std::size_t> offered;  // to the last worker of them, and it sleeps perhaps
  for (const body::SegmentState& state : states) {
    if (state.slot != 0) {
      continue;  // the filter that runs beside the one in use
    }
    counters_.Add(Count::kStatesReceived);
    const std::size_t worker = WorkerOf(state.body_id);
    if (!workers_[worker]->Offer(MakeStateInput(state, received_at))) {
      counters_.Add(Count::kStatesDropped);
      continue;
    }
    if (offered && *offered != worker) {
      pool_.Wake(*offered);
    }
    offered = worker;
  }
  if (offered) {
    pool_.Wake(*offered);
  }
}

void PostureService::HandOver(BodyId body_id, PostureWorker::Item item) {
  const std::size_t worker = WorkerOf(body_id);
  if (!workers_[worker]->OfferUrgent(std::move(item))) {
    SetLastError("queue of worker " + std::to_string(worker) + " is full: a request was lost");
    return;
  }
  pool_.Wake(worker);
}

void PostureService::SetLastError(const std::string& message) {
  const std::scoped_lock lock(error_mutex_);
  if (message != last_error_) {
    spdlog::warn("{}", message);  // once, not for every skeleton
    last_error_ = message;
  }
}

void PostureService::FillHealth(ServiceHealth& health) {
  for (std::size_t i = 0; i < kCountCount; ++i) {
    const auto count = static_cast<Count>(i);
    health.values.push_back(
        {std::string(NameOf(count)), static_cast<double>(counters_.Read(count))});
  }
  std::size_t bodies = 0;
  for (const auto& worker : workers_) {
    bodies += worker->body_count();
  }
  health.values.push_back({"gauge.bodies", static_cast<double>(bodies)});
  if (state_reader_ != nullptr) {
    health.values.push_back({"states.lost", static_cast<double>(state_reader_->lost())});
    health.values.push_back(
        {"gauge.state_writers", static_cast<double>(state_reader_->alive_writers())});
  }
  if (skeleton_writer_ != nullptr) {
    health.values.push_back(
        {"gauge.skeleton_readers", static_cast<double>(skeleton_writer_->counters().matched)});
  }
  {
    const std::scoped_lock lock(error_mutex_);
    if (health.last_error.empty()) {
      health.last_error = last_error_;
    }
  }
  health.latencies.push_back(latencies_.sensor_to_posture.Take("sensor_to_posture"));
  health.latencies.push_back(latencies_.fusion_to_posture.Take("fusion_to_posture"));
  health.latencies.push_back(latencies_.posture.Take("posture"));
}

}  // namespace limbcast::posture
