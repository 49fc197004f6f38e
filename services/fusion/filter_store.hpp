#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <span>
#include <unordered_map>
#include <vector>

#include "common/base/ids.hpp"
#include "common/base/result.hpp"
#include "common/base/time.hpp"
#include "common/filters/filter.hpp"

namespace limbcast::fusion {

/// What the filters of one worker knew at one moment. Filled by the worker; others look at it after
/// `complete`.
struct FilterSnapshot {
  /// For each sensor its uid, a size and what its filter saved.
  std::vector<std::byte> entries;
  std::uint32_t count = 0;
  std::atomic<bool> complete = false;

  void Clear();
  void Add(SensorUid sensor_uid, const filters::OrientationFilter& filter);
};

/// Saved filter states by sensor, each given out once. Thread-safe.
class SavedFilters {
 public:
  void Add(SensorUid sensor_uid, std::span<const std::byte> state);
  /// Empty: there is none.
  [[nodiscard]] std::vector<std::byte> Take(SensorUid sensor_uid);
  [[nodiscard]] std::size_t size() const;

 private:
  mutable std::mutex mutex_;
  std::unordered_map<SensorUid, std::vector<std::byte>> states_;
};

/// The file `filters.state` of a folder: with it, a fusion service that is started again goes on
/// with the gyro biases, headings and field references it had. For the same build and the same
/// filter settings; anything else begins anew. Thread-compatible.
class FilterStore {
 public:
  /// @param folder    "" keeps nothing.
  /// @param settings  a number that differs when the filters' settings do.
  FilterStore(std::filesystem::path folder, std::uint64_t settings);

  [[nodiscard]] bool keeps() const { return !folder_.empty(); }

  /// Makes the folder; fails with kUnavailable naming fusion.state_dir.
  [[nodiscard]] Status Prepare() const;

  /// Replaces the file as a whole. Fails with kUnavailable naming file and reason; the file before
  /// stays then.
  [[nodiscard]] Status Save(std::span<const std::shared_ptr<FilterSnapshot>> snapshots,
                            Time now) const;

  /// Adds the states to `saved`: none when there is no file, or when it is older than `max_age`
  /// (a clock that was set back makes no difference), or of other settings. Fails with kCorruptData
  /// naming file and reason, adds nothing, and renames the file to filters.state.refused.
  [[nodiscard]] Status Load(Time now, Duration max_age, SavedFilters& saved) const;

 private:
  [[nodiscard]] std::filesystem::path path() const { return folder_ / "filters.state"; }

  const std::filesystem::path folder_;
  const std::uint64_t settings_;
};

}  // namespace limbcast::fusion
