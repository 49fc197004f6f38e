#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/health.hpp"
#include "common/base/result.hpp"
#include "common/bus/bus.hpp"
#include "common/bus/segment_state_reader.hpp"
#include "common/runtime/latency_histogram.hpp"
#include "common/runtime/worker_pool.hpp"
#include "services/gateway/coil_grants.hpp"
#include "services/gateway/driver.hpp"
#include "services/gateway/flow_control.hpp"
#include "services/gateway/gateway_config.hpp"
#include "services/gateway/gateway_summary.hpp"
#include "services/gateway/sample_publisher.hpp"
#include "services/gateway/tick_source.hpp"

namespace limbcast::gateway {

/// Plays one driver onto the network: waits for the pipeline if told to, paces, numbers, flags and
/// publishes tick by tick. All work is done in the first worker of the pool, which sleeps between
/// ticks; a test drives it with ImmediatePool and FakeClock. What becomes of its samples is none of
/// its business: it goes on when fusion dies.
///
///   waiting ──way open or timeout──► streaming ──end of data──► lingering ──► ended
class GatewayService {
 public:
  /// `config` is valid. `clock`, `bus` and `pool` (not started, at least one worker) outlive it.
  /// `on_end` is called once from the worker when the data have ended and have had time to arrive,
  /// or the service has failed; it may be empty.
  GatewayService(GatewayConfig config, std::unique_ptr<Driver> driver, const Clock& clock,
                 bus::Bus& bus, runtime::WorkerPool& pool, std::function<void()> on_end = {});
  ~GatewayService() { Stop(); }
  GatewayService(const GatewayService&) = delete;
  GatewayService& operator=(const GatewayService&) = delete;

  /// Joins the topics, announces sensors and people, starts. Called once.
  [[nodiscard]] Status Start();

  /// Ends the stream, takes the sensors back. Idempotent.
  void Stop();

  /// The data have ended, or the service has failed.
  [[nodiscard]] bool ended() const;
  /// Why it failed, else Ok.
  [[nodiscard]] Status result() const;

  /// Thread-safe. The numbers of each sensor only after Stop.
  [[nodiscard]] GatewaySummary Summary() const;
  /// Thread-safe, for one caller.
  void FillHealth(ServiceHealth& health);

 private:
  enum class Phase { kWaiting, kStreaming, kLingering, kEnded };

  [[nodiscard]] Status MakeReaders();
  std::optional<Time> Drain();
  std::optional<Time> Wait(Time now);
  std::optional<Time> Stream();
  [[nodiscard]] std::optional<Time> LoadTick(Time now);
  [[nodiscard]] std::optional<Time> NotYet(Time now);
  [[nodiscard]] Phase phase() const;
  void SetPhase(Phase phase);
  void SendTick(Time now);
  std::optional<Time> Linger(Time now);
  void BeginStreaming(Time now);
  void EndOfData(Time now);
  void Fail(const Error& error);
  void End(const char* how);
  void SetLastError(const std::string& message);

  GatewayConfig config_;
  const Clock& clock_;
  bus::Bus& bus_;
  runtime::WorkerPool& pool_;
  const std::function<void()> on_end_;
  std::unique_ptr<FlowControl> flow_;
  std::unique_ptr<SamplePublisher> publisher_;
  std::atomic<bool> started_{false};
  std::atomic<bool> stopping_{false};
  std::atomic<bool> stopped_{false};

  // Of the worker alone.
  TickSource source_;
  std::optional<Time> waiting_since_;
  Time next_probe_at_{};
  Time last_probe_at_{};
  std::optional<Time> first_sent_at_;
  std::optional<Time> linger_until_;
  Time retry_at_{};

  mutable std::mutex mutex_;  // guards the three below; never held while writing or in the driver
  Phase phase_ = Phase::kWaiting;
  GatewaySummary summary_;
  std::optional<Error> failure_;

  runtime::LatencyHistogram lag_;       // from due to sent
  runtime::LatencyHistogram burst_;     // from the first to the last write of a tick
  std::unique_ptr<CoilGrants> grants_;  // null: nobody wears coils
  std::unique_ptr<bus::SegmentStateReader> state_reader_;
  std::unique_ptr<bus::Reader<body::Skeleton>> skeleton_reader_;
};

}  // namespace limbcast::gateway
