#pragma once

#include <memory>
#include <mutex>
#include <utility>

#include "common/base/result.hpp"
#include "common/bus/bus.hpp"
#include "common/bus/segment_state_reader.hpp"
#include "tools/limbcast/monitor/pipeline_model.hpp"

namespace limbcast::tool {

/// A PipelineModel that listens to a bus. Thread-safe.
class PipelineView {
 public:
  struct Options {
    bool segment_states = true;  ///< 15 samples for each skeleton: costs the pipeline something
    bool truth = true;
  };
  /// Fails when the bus does. `bus` outlives it.
  [[nodiscard]] static Result<std::unique_ptr<PipelineView>> Make(bus::Bus& bus, Options options);

  PipelineView(const PipelineView&) = delete;
  PipelineView& operator=(const PipelineView&) = delete;

  /// Calls `use(model)` while nothing changes it, and gives what that gives.
  template <typename Use>
  auto With(Use&& use) {
    const std::lock_guard lock(mutex_);
    return std::forward<Use>(use)(model_);
  }

  /// Posture services that this client hears now.
  [[nodiscard]] int skeleton_writers() const { return skeletons_->counters().matched; }

 private:
  PipelineView() = default;
  template <typename T, typename Use>
  [[nodiscard]] Status Listen(bus::Bus& bus, std::unique_ptr<bus::Reader<T>>& reader, Use use);

  std::mutex mutex_;  // guards model_
  PipelineModel model_;
  std::unique_ptr<bus::Reader<ServiceHealth>> health_;
  std::unique_ptr<bus::Reader<roster::RosterEntry>> roster_;
  std::unique_ptr<bus::Reader<body::Skeleton>> skeletons_;
  std::unique_ptr<bus::SegmentStateReader> states_;
  std::unique_ptr<bus::Reader<body::SegmentTruth>> truths_;
};

}  // namespace limbcast::tool
