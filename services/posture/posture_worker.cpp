#include "services/posture/posture_worker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "common/base/expects.hpp"
#include "common/body/default_body.hpp"

namespace limbcast::posture {
namespace {

/// A person's name as that of a profile.
std::string ProfileOf(const body::BodyDefinition& definition) {
  return definition.name.substr(0, AlignmentStore::kMaxProfileName);
}

bool NeedsAlignment(const body::SegmentDefinition& segment) {
  return segment.tracked && !segment.aligned;
}

bool NeedsAlignment(const body::BodyDefinition& definition) {
  return std::any_of(definition.segments.begin(), definition.segments.end(),
                     [](const auto& segment) { return NeedsAlignment(segment); });
}

Count CountOf(StateFate fate) {
  switch (fate) {
    case StateFate::kUsed:
      return Count::kStatesUsed;
    case StateFate::kLate:
      return Count::kStatesLate;
    case StateFate::kIgnored:
      return Count::kStatesIgnored;
    case StateFate::kUnassigned:
      break;
  }
  return Count::kStatesUnassigned;
}

}  // namespace

PostureWorker::PostureWorker(const PostureShared& shared)
    : shared_(shared), queue_(kQueueCapacity) {
  angles_.joints.reserve(body::kJointCount);
}

std::optional<Time> PostureWorker::Drain() {
  while (queue_.TryPop(item_)) {
    std::visit([this](const auto& work) { Handle(work); }, item_);
  }
  if (earliest_due_) {
    const Time now = shared_.clock.Now();
    if (*earliest_due_ <= now) {
      EmitDue(now);
    }
  }
  if (std::exchange(to_flush_, false)) {
    shared_.skeletons.Flush();
    if (shared_.joint_angles != nullptr) {
      shared_.joint_angles->Flush();
    }
  }
  return earliest_due_;
}

void PostureWorker::EmitDue(Time now) {
  earliest_due_.reset();
  for (auto& [body_id, body] : bodies_) {
    body.tracker->OnDue(now);
    if (const auto due = body.tracker->due()) {
      earliest_due_ = std::min(earliest_due_.value_or(*due), *due);
    }
  }
}

PostureWorker::Body* PostureWorker::Find(BodyId body_id) {
  const auto found = bodies_.find(body_id);
  return found == bodies_.end() ? nullptr : &found->second;
}

PostureWorker::Body& PostureWorker::MakeBody(BodyId body_id) {
  auto made = body::MakeDefaultBody(body_id, shared_.config.body_height_m);
  Expects(made.ok(), "a validated body height");
  body::BodyDefinition definition = std::move(*made);
  if (!shared_.config.segments.empty()) {
    definition = body::KeepSegments(definition, shared_.config.segments);
  }
  if (const auto loaded = shared_.store.Load(definition); !loaded) {
    shared_.on_error("saved alignment refused: " + loaded.error().message);
  }
  Body& body = bodies_.try_emplace(body_id, shared_.config).first->second;
  body.tracker = std::make_unique<BodyTracker>(
      shared_.config, std::move(definition),
      [this](body::Skeleton& skeleton, TickEnd end, bool live) { Publish(skeleton, end, live); });
  return body;
}

void PostureWorker::Handle(const StateInput& state) {
  Body* body = Find(state.body_id);
  if (body == nullptr) {
    shared_.counters.Add(Count::kStatesUnassigned);
    return;
  }
  BodyTracker& tracker = *body->tracker;
  shared_.counters.Add(CountOf(tracker.OnState(state, state.stages.posture_received_at)));
  if (const auto due = tracker.due()) {
    earliest_due_ = std::min(earliest_due_.value_or(*due), *due);
  }
  if (tracker.TakeDefinitionChanged()) {
    PublishDefinition(*body);
    if (const auto calibrated = tracker.TakeCalibrated()) {
      shared_.counters.Add(Count::kCalibrations);
      (void)Save(*body);
    }
  }
}

void PostureWorker::Handle(const sensing::PositionFix& fix) {
  if (Body* body = Find(fix.body_id);
      body != nullptr && fix.p_earth_body_m.allFinite() && fix.cov_m2.allFinite()) {
    body->tracker->OnPositionFix(fix);
  }
}

void PostureWorker::Handle(const std::shared_ptr<const roster::RosterEntry>& entry) {
  Body* body = Find(entry->body_id);
  if (body == nullptr) {
    body = &MakeBody(entry->body_id);
  }
  const bool back = !std::exchange(body->present, true);
  const bool changed = body->tracker->SetRoster(*entry);
  if (changed) {
    RestoreProfile(*body);
    AdoptPublished(*body);
  }
  if (body->tracker->TakeDefinitionChanged() || changed || back) {
    PublishDefinition(*body);
  }
  CountBodies();
}

void PostureWorker::Handle(const Gone& gone) {
  published_.erase(gone.body_id);
  Body* body = Find(gone.body_id);
  if (body == nullptr || !std::exchange(body->present, false)) {
    return;
  }
  // The alignment stays, for the return of the same sensors.
  const body::BodyDefinition& definition = body->tracker->definition();
  roster::RosterEntry nobody;
  nobody.body_id = gone.body_id;
  nobody.person = definition.name;
  (void)body->tracker->SetRoster(nobody);
  (void)body->tracker->TakeDefinitionChanged();
  body::Skeleton skeleton;
  skeleton.body_id = gone.body_id;
  Check(shared_.skeletons.Dispose(skeleton));
  if (shared_.joint_angles != nullptr) {
    body::JointAngleFrame angles;
    angles.body_id = gone.body_id;
    Check(shared_.joint_angles->Dispose(angles));
  }
  Check(shared_.definitions.Dispose(definition));
  CountBodies();
}

void PostureWorker::Handle(const std::shared_ptr<const roster::Command>& command) {
  if (const roster::CommandReply* before = answered_.Find(*command)) {
    Answer(*before);  // the answer was lost, or is under way
    return;
  }
  Body* body = Find(command->body_id);
  CommandOutcome outcome;
  if (body == nullptr || !body->present) {
    outcome.message = fmt::format("no body {} in the roster", command->body_id.value);
  } else {
    outcome = command->kind == roster::CommandKind::kProfile
                  ? UseProfile(*command, *body)
                  : body->commands.Execute(*command, shared_.clock.Now(), *body->tracker);
    if (body->tracker->TakeDefinitionChanged()) {
      PublishDefinition(*body);
    }
    if (outcome.accepted && outcome.changes && !Save(*body)) {
      outcome.message += " (not saved to disk)";
    }
  }
  shared_.counters.Add(outcome.accepted ? Count::kCommandsAccepted : Count::kCommandsRefused);
  const roster::CommandReply reply{.client_uid = command->client_uid,
                                   .request_id = command->request_id,
                                   .accepted = outcome.accepted,
                                   .message = outcome.message};
  answered_.Add(reply);
  Answer(reply);
}

void PostureWorker::Answer(const roster::CommandReply& reply) {
  Check(shared_.replies.Write(reply));
  shared_.replies.Flush();
}

bool PostureWorker::Save(const Body& body) {
  const body::BodyDefinition& definition = body.tracker->definition();
  Status saved = shared_.store.Save(definition);
  if (saved && !shared_.config.state_dir.empty() && !definition.name.empty()) {
    saved = shared_.store.SaveProfile(ProfileOf(definition), definition);
  }
  if (!saved) {
    shared_.on_error("alignment not saved: " + saved.error().message);
  }
  return saved.ok();
}

void PostureWorker::RestoreProfile(Body& body) {
  body::BodyDefinition definition = body.tracker->definition();
  const std::string name = ProfileOf(definition);
  if (!NeedsAlignment(definition) || !shared_.store.HasProfile(name)) {
    return;
  }
  const body::BodyDefinition before = definition;
  const auto aligned = shared_.store.LoadProfile(name, definition);
  if (!aligned) {
    shared_.on_error("profile refused: " + aligned.error().message);
    return;
  }
  for (std::size_t row = 0; row < definition.segments.size(); ++row) {
    if (!NeedsAlignment(before.segments[row])) {
      definition.segments[row] = before.segments[row];  // what is in force is newer
    }
  }
  body.tracker->Restore(std::move(definition), shared_.clock.Now());
}

void PostureWorker::Handle(const std::shared_ptr<const body::BodyDefinition>& published) {
  published_[published->body_id] = published;
  Body* body = Find(published->body_id);
  if (body != nullptr && body->present) {
    AdoptPublished(*body);
    if (body->tracker->TakeDefinitionChanged()) {
      PublishDefinition(*body);
    }
  }
}

void PostureWorker::AdoptPublished(Body& body) {
  body::BodyDefinition definition = body.tracker->definition();
  const auto published = published_.find(definition.body_id);
  // What is not newer may be our own from before an undo.
  if (published == published_.end() || !NeedsAlignment(definition) ||
      published->second->revision <= definition.revision) {
    return;
  }
  bool adopted = false;
  for (body::SegmentDefinition& into : definition.segments) {
    const auto* const from = body::Find(*published->second, into.segment);
    if (from != nullptr && NeedsAlignment(into) && from->aligned &&
        from->sensor_uid == into.sensor_uid) {
      body::TakeAlignment(*from, into);
      adopted = true;
    }
  }
  if (!adopted) {
    return;
  }
  for (body::SegmentDefinition& into : definition.segments) {
    if (const auto* const from = body::Find(*published->second, into.segment)) {
      body::TakeDimensions(*from, into);
    }
  }
  if (const Status valid = body::Validate(definition); !valid) {
    shared_.on_error("published body_definition refused: " + valid.error().message);
    return;
  }
  body.tracker->Redefine(std::move(definition), shared_.clock.Now());
  shared_.counters.Add(Count::kAdopted);
  (void)Save(body);
}

CommandOutcome PostureWorker::UseProfile(const roster::Command& command, Body& body) {
  const std::size_t space = command.text.find(' ');
  const std::string verb = command.text.substr(0, space);
  const std::string name = space == std::string::npos ? "" : command.text.substr(space + 1);
  body.tracker->FoldHeadings();
  if (verb == "save") {
    const Status saved = shared_.store.SaveProfile(name, body.tracker->definition());
    return saved ? CommandOutcome{true, "profile " + name + " saved", false}
                 : CommandOutcome{false, saved.error().message, false};
  }
  if (verb != "load") {
    return {false,
            fmt::format("profile must be \"save NAME\" or \"load NAME\", is \"{}\"", command.text),
            false};
  }
  body::BodyDefinition definition = body.tracker->definition();
  const auto aligned = shared_.store.LoadProfile(name, definition);
  if (!aligned) {
    return {false, aligned.error().message, false};
  }
  body.commands.Adopt(std::move(definition), shared_.clock.Now(), *body.tracker);
  return {true, fmt::format("profile {} in force, {} segments aligned", name, *aligned)};
}

void PostureWorker::Publish(body::Skeleton& skeleton, TickEnd end, bool live) {
  skeleton.stages.posture_published_at = shared_.clock.Now();
  const Status written = shared_.skeletons.Write(skeleton);
  Check(written);
  to_flush_ = true;
  if (!live) {
    shared_.counters.Add(Count::kProbes);
    return;
  }
  PublishJointAngles(skeleton);
  const body::StageTimes& stages = skeleton.stages;
  shared_.latencies.sensor_to_posture.Record(stages.posture_published_at - skeleton.measured_at);
  shared_.latencies.fusion_to_posture.Record(stages.posture_received_at -
                                             stages.fusion_published_at);
  shared_.latencies.posture.Record(stages.posture_published_at - stages.posture_received_at);
  shared_.counters.Add(Count::kSkeletons);
  if (skeleton.complete) {
    shared_.counters.Add(Count::kSkeletonsComplete);
  }
  if (end == TickEnd::kDeadline) {
    shared_.counters.Add(Count::kSkeletonsDeadline);
  } else if (end == TickEnd::kOvertaken) {
    shared_.counters.Add(Count::kSkeletonsOvertaken);
  }
}

void PostureWorker::PublishJointAngles(const body::Skeleton& skeleton) {
  if (shared_.joint_angles == nullptr || shared_.joint_angles->counters().matched == 0) {
    return;
  }
  body::FillJointAngles(skeleton, angles_);
  Check(shared_.joint_angles->Write(angles_));
}

void PostureWorker::PublishDefinition(Body& body) {
  shared_.counters.Add(Count::kDefinitions);
  Check(shared_.definitions.Write(body.tracker->definition()));
  shared_.definitions.Flush();
}

void PostureWorker::CountBodies() {
  body_count_.store(
      static_cast<std::size_t>(std::count_if(
          bodies_.begin(), bodies_.end(), [](const auto& entry) { return entry.second.present; })),
      std::memory_order_relaxed);
}

void PostureWorker::Check(const Status& status) {
  if (!status) {
    shared_.counters.Add(Count::kPublishErrors);
    shared_.on_error(status.error().message);
  }
}

}  // namespace limbcast::posture
