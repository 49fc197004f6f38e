#pragma once

#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/health.hpp"
#include "common/base/result.hpp"
#include "common/bus/bus.hpp"
#include "common/bus/segment_state_reader.hpp"
#include "common/runtime/worker_pool.hpp"
#include "services/posture/alignment_store.hpp"
#include "services/posture/posture_config.hpp"
#include "services/posture/posture_counters.hpp"
#include "services/posture/posture_worker.hpp"

namespace limbcast::posture {

/// Segment states in, skeletons out: each body of the roster gets a default person, whose segments
/// with sensors follow their states (slot 0). A skeleton is emitted when its tick is complete or
/// late (tick_assembler.hpp); the definition is published with every change; commands
/// (commands.hpp) are answered. Reader callbacks only enqueue; a body always belongs to the same
/// worker, so the skeletons do not depend on the number of workers.
class PostureService {
 public:
  /// `config` is valid (Validate). `clock`, `bus` and `pool` outlive it; `pool` is not started.
  PostureService(PostureConfig config, const Clock& clock, bus::Bus& bus,
                 runtime::WorkerPool& pool);
  ~PostureService() { Stop(); }
  PostureService(const PostureService&) = delete;
  PostureService& operator=(const PostureService&) = delete;

  /// Joins the topics and starts the pool. Called once. Fails when the bus or the state folder
  /// refuses.
  [[nodiscard]] Status Start();

  /// Leaves the topics, finishes what is queued, stops the pool. Idempotent.
  void Stop();

  [[nodiscard]] const PostureCounters& counters() const { return counters_; }

  /// Adds values and latencies (those since the last call). Thread-safe, for one caller.
  void FillHealth(ServiceHealth& health);

 private:
  [[nodiscard]] Status MakeWriters();
  [[nodiscard]] Status MakeReaders();
  template <typename T>
  [[nodiscard]] Status Listen(std::unique_ptr<bus::Reader<T>>& reader,
                              bus::ReaderHandler<T> handler);
  [[nodiscard]] std::size_t WorkerOf(BodyId body_id) const;
  void OnStates(std::span<const body::SegmentState> states, Time received_at);
  void HandOver(BodyId body_id, PostureWorker::Item item);
  void SetLastError(const std::string& message);

  const PostureConfig config_;
  const Clock& clock_;
  bus::Bus& bus_;
  runtime::WorkerPool& pool_;
  const AlignmentStore store_;
  PostureCounters counters_;
  PostureLatencies latencies_;
  std::mutex error_mutex_;  // guards last_error_
  std::string last_error_;

  bool started_ = false;
  std::unique_ptr<bus::Writer<body::Skeleton>> skeleton_writer_;
  std::unique_ptr<bus::Writer<body::JointAngleFrame>> joint_angle_writer_;  // null: not published
  std::unique_ptr<bus::Writer<body::BodyDefinition>> definition_writer_;
  std::unique_ptr<bus::Writer<roster::CommandReply>> reply_writer_;
  std::unique_ptr<PostureShared> shared_;
  std::vector<std::unique_ptr<PostureWorker>> workers_;
  std::unique_ptr<bus::Reader<roster::RosterEntry>> roster_reader_;
  std::unique_ptr<bus::Reader<body::BodyDefinition>> definition_reader_;
  std::unique_ptr<bus::Reader<roster::Command>> command_reader_;
  std::unique_ptr<bus::Reader<sensing::PositionFix>> fix_reader_;
  std::unique_ptr<bus::SegmentStateReader> state_reader_;
};

}  // namespace limbcast::posture
