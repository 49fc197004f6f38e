#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <variant>

#include "common/base/clock.hpp"
#include "common/body/body_definition.hpp"
#include "common/body/joint_angle_frame.hpp"
#include "common/body/skeleton.hpp"
#include "common/bus/writer.hpp"
#include "common/roster/answered_commands.hpp"
#include "common/roster/command.hpp"
#include "common/roster/roster.hpp"
#include "common/runtime/bounded_queue.hpp"
#include "common/runtime/latency_histogram.hpp"
#include "common/sensing/position_samples.hpp"
#include "services/posture/alignment_store.hpp"
#include "services/posture/body_tracker.hpp"
#include "services/posture/commands.hpp"
#include "services/posture/posture_counters.hpp"
#include "services/posture/state_input.hpp"

namespace limbcast::posture {

/// Latencies of all workers, by stage; of ticks with an orientation only. Thread-safe.
struct PostureLatencies {
  runtime::LatencyHistogram sensor_to_posture;  ///< measured → skeleton published
  runtime::LatencyHistogram fusion_to_posture;  ///< last state published by fusion → received here
  runtime::LatencyHistogram posture;            ///< last state received → skeleton published
};

/// What the workers share. All of it is thread-safe and outlives them.
struct PostureShared {
  const PostureConfig& config;
  const Clock& clock;
  const AlignmentStore& store;
  bus::Writer<body::Skeleton>& skeletons;
  bus::Writer<body::JointAngleFrame>* joint_angles;  ///< null: not published
  bus::Writer<body::BodyDefinition>& definitions;
  bus::Writer<roster::CommandReply>& replies;
  PostureCounters& counters;
  PostureLatencies& latencies;
  std::function<void(const std::string& message)> on_error;  ///< for the log and `health`
};

/// One shard: a queue, and the bodies that belong to it. Offer from any thread, Drain from one.
class PostureWorker {
 public:
  struct Gone {
    BodyId body_id;
  };
  using Item =
      std::variant<StateInput, sensing::PositionFix, std::shared_ptr<const roster::RosterEntry>,
                   std::shared_ptr<const roster::Command>,
                   std::shared_ptr<const body::BodyDefinition>, Gone>;

  explicit PostureWorker(const PostureShared& shared);

  /// False: the queue is full. Some places are kept for what must not be lost.
  [[nodiscard]] bool Offer(const StateInput& state) {
    return queue_.TryPush(Item(state), kKeptForOthers);
  }
  [[nodiscard]] bool OfferUrgent(Item item) { return queue_.TryPush(std::move(item)); }

  /// Works off the queue, emits what is due, and says when to be called next.
  [[nodiscard]] std::optional<Time> Drain();

  [[nodiscard]] std::size_t body_count() const {
    return body_count_.load(std::memory_order_relaxed);
  }

 private:
  static constexpr std::size_t kQueueCapacity = 4096;
  static constexpr std::size_t kKeptForOthers = 64;

  struct Body {
    explicit Body(const PostureConfig& config) : commands(config) {}
    std::unique_ptr<BodyTracker> tracker;
    BodyCommands commands;
    bool present = true;  // in the roster
  };

  void Handle(const StateInput& state);
  void Handle(const sensing::PositionFix& fix);
  void Handle(const std::shared_ptr<const roster::RosterEntry>& entry);
  void Handle(const std::shared_ptr<const roster::Command>& command);
  /// What a posture service says of a body: another one, or this one.
  void Handle(const std::shared_ptr<const body::BodyDefinition>& published);
  void Handle(const Gone& gone);
  Body* Find(BodyId body_id);
  Body& MakeBody(BodyId body_id);
  CommandOutcome UseProfile(const roster::Command& command, Body& body);
  /// The profile of the person who came, for sensors that are not aligned.
  void RestoreProfile(Body& body);
  /// What another posture service has in force, for sensors that are not aligned here: a service
  /// that is started again, or stands by, asks nobody for a calibration.
  void AdoptPublished(Body& body);
  /// For this body, and as the profile of its person. False: not on the disk.
  bool Save(const Body& body);
  void Answer(const roster::CommandReply& reply);
  void Publish(body::Skeleton& skeleton, TickEnd end, bool live);
  void PublishJointAngles(const body::Skeleton& skeleton);
  void PublishDefinition(Body& body);
  void EmitDue(Time now);
  void CountBodies();
  void Check(const Status& status);

  const PostureShared& shared_;
  runtime::BoundedQueue<Item> queue_;
  Item item_;                     // the one in work
  body::JointAngleFrame angles_;  // reused
  std::unordered_map<BodyId, Body> bodies_;
  std::unordered_map<BodyId, std::shared_ptr<const body::BodyDefinition>> published_;  // the last
  roster::AnsweredCommands answered_;
  std::optional<Time> earliest_due_;  // no body is due before; it may have become later
  bool to_flush_ = false;
  std::atomic<std::size_t> body_count_{0};
};

}  // namespace limbcast::posture
