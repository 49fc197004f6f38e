#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_set>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/health.hpp"
#include "common/base/result.hpp"
#include "common/bus/bus.hpp"
#include "common/roster/answered_commands.hpp"
#include "common/runtime/worker_pool.hpp"
#include "services/fusion/filter_keeper.hpp"
#include "services/fusion/filter_store.hpp"
#include "services/fusion/fusion_config.hpp"
#include "services/fusion/fusion_counters.hpp"
#include "services/fusion/fusion_worker.hpp"
#include "services/fusion/router.hpp"

namespace limbcast::fusion {

/// Samples in, segment states out: routes each sample to the worker of its body, which filters and
/// publishes it. Reader callbacks only look up and enqueue. Every sample of an assigned sensor is
/// answered by exactly one state of slot 0, used or refused, in the order in which the sensor's
/// samples came; only samples that find the queue full are answered by the counters of the next
/// state alone. The states do not depend on the number of workers.
///
/// A sensor belongs to the body whose roster entry named it last. Commands of kind kSelectFilter
/// are answered here: `text` is the name of a filter, or "beside NAME" / "beside none" for the one
/// run beside it (slot 1); `numbers` are segments (none = all); body 0 = all bodies.
class FusionService {
 public:
  /// `config` is valid (Validate). `clock`, `bus` and `pool` outlive it; `pool` is not started.
  /// An empty `factory` means MakeFilterFactory(config).
  FusionService(FusionConfig config, const Clock& clock, bus::Bus& bus, runtime::WorkerPool& pool,
                FilterFactory factory = {});
  ~FusionService() { Stop(); }
  FusionService(const FusionService&) = delete;
  FusionService& operator=(const FusionService&) = delete;

  /// Joins the topics and starts the pool. Called once. Fails when the bus refuses, or the folder
  /// of `state_dir` cannot be written to.
  [[nodiscard]] Status Start();

  /// Leaves the topics, finishes what is queued, stops the pool. Idempotent.
  void Stop();

  [[nodiscard]] FusionCounters counters() const;

  /// Adds values and latencies (those since the last call). Thread-safe, for one caller.
  void FillHealth(ServiceHealth& health);

 private:
  template <typename T>
  [[nodiscard]] Status Listen(std::unique_ptr<bus::Reader<T>>& reader,
                              bus::ReaderHandler<T> handler);
  [[nodiscard]] Status MakeReaders();
  void OnMarker(const sensing::MarkerPosition& marker, Time received_at);
  void OnFrame(const sensing::MargFrame& frame, Time received_at);
  template <typename Sample>
  void OnSample(const Sample& sample, Time received_at);
  template <typename Sample>
  [[nodiscard]] std::uint64_t Take(const Sample& sample, Time received_at);
  void OnCommand(const roster::Command& command);
  void Answer(const roster::CommandReply& reply);
  [[nodiscard]] Result<std::string> SelectFilter(const roster::Command& command,
                                                 std::uint64_t& touched);
  [[nodiscard]] std::uint64_t HandOver(std::vector<BodyPlan> plans);
  void Wake(std::uint64_t touched);
  [[nodiscard]] Status TakeUpFilters();
  void KeepFilters();
  void SetLastError(const std::string& message);

  const FusionConfig config_;
  const FilterFactory factory_;
  const Clock& clock_;
  bus::Bus& bus_;
  runtime::WorkerPool& pool_;
  FusionLatencies latencies_;

  // Held to look up and enqueue, so that a sample never overtakes the plan that it follows; never
  // during a filter step, a write or a wake.
  mutable std::mutex intake_mutex_;
  Router router_;
  CounterCells intake_counters_;
  std::unordered_set<SensorUid> announced_;  // by sensor_info
  std::string last_error_;

  roster::AnsweredCommands answered_;  // by the one command reader, which calls one at a time

  const FilterStore store_;
  SavedFilters saved_filters_;
  FilterKeeper keeper_;

  mutable std::mutex endpoints_mutex_;  // Stop takes the readers while FillHealth looks at them
  bool started_ = false;
  StateWriters state_writers_;
  std::unique_ptr<bus::Writer<roster::CommandReply>> reply_writer_;
  std::vector<std::unique_ptr<FusionWorker>> workers_;
  std::unique_ptr<bus::Reader<roster::RosterEntry>> roster_reader_;
  std::unique_ptr<bus::Reader<sensing::SensorInfo>> sensor_info_reader_;
  std::unique_ptr<bus::Reader<roster::Command>> command_reader_;
  std::unique_ptr<bus::Reader<sensing::MargSample>> marg_reader_;
  std::unique_ptr<bus::Reader<sensing::MargFrame>> marg_frame_reader_;
  std::unique_ptr<bus::Reader<sensing::FusedOrientation>> orientation_reader_;
  std::unique_ptr<bus::Reader<sensing::MarkerPosition>> marker_reader_;  // with marker tracks only
};

}  // namespace limbcast::fusion
