#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "common/runtime/periodic_thread.hpp"
#include "services/fusion/filter_store.hpp"

namespace limbcast::fusion {

/// Every now and then asks the workers what their filters know, and writes to the store what they
/// answered to the question before: nobody waits for anybody.
class FilterKeeper {
 public:
  /// Puts the question among a worker's work. False: no room.
  using Ask = std::function<bool(std::size_t worker, std::shared_ptr<FilterSnapshot>)>;
  using Tell = std::function<void(const Status&)>;

  /// `store` and `clock` outlive it. `tell` hears of each attempt to write.
  FilterKeeper(const FilterStore& store, const Clock& clock, std::size_t workers, Ask ask,
               Tell tell);

  /// Calls Tick once in each period on a thread of its own, until Stop.
  void Start(Duration period);
  void Stop() { thread_.reset(); }

  /// Writes when all have answered, and asks all again then.
  void Tick();

  /// Writes what `snapshots` says, one for each worker. After Stop.
  void SaveNow(std::vector<std::shared_ptr<FilterSnapshot>> snapshots);

  [[nodiscard]] std::uint64_t saved() const { return saved_; }
  [[nodiscard]] std::uint64_t errors() const { return errors_; }

 private:
  void Save();
  void Renew();

  const FilterStore& store_;
  const Clock& clock_;
  const Ask ask_;
  const Tell tell_;
  std::vector<std::shared_ptr<FilterSnapshot>> asked_;
  bool waiting_ = false;  // for answers
  std::atomic<std::uint64_t> saved_{0};
  std::atomic<std::uint64_t> errors_{0};
  std::optional<runtime::PeriodicThread> thread_;
};

}  // namespace limbcast::fusion
