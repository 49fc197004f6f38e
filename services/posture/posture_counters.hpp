#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace limbcast::posture {

/// What the service counts. Every state that arrives is counted as received and then as one of
/// used, late, ignored, unassigned or dropped.
enum class Count : std::uint8_t {
  kStatesReceived,
  kStatesUsed,
  kStatesLate,        ///< their tick had been emitted
  kStatesIgnored,     ///< duplicate, out of order, or with a time or orientation that cannot be
  kStatesUnassigned,  ///< the roster does not have this sensor on this segment
  kStatesDropped,     ///< the queue of the worker was full
  kSkeletons,         ///< with at least one oriented segment; the four below are parts of it
  kSkeletonsComplete,
  kSkeletonsDeadline,
  kSkeletonsOvertaken,
  kProbes,  ///< skeletons of a tick in which no segment has an orientation yet
  kCommandsAccepted,
  kCommandsRefused,
  kDefinitions,
  kPublishErrors,
  kCalibrations,  ///< that the service made by itself
  kAdopted,       ///< alignments taken over from another posture service
};
inline constexpr std::size_t kCountCount = 17;

/// As in `health`: "states.received", ...
[[nodiscard]] constexpr std::string_view NameOf(Count count) {
  constexpr std::array<std::string_view, kCountCount> kNames = {"states.received",
                                                                "states.used",
                                                                "states.late",
                                                                "states.ignored",
                                                                "states.unassigned",
                                                                "states.dropped",
                                                                "skeletons",
                                                                "skeletons.complete",
                                                                "skeletons.deadline",
                                                                "skeletons.overtaken",
                                                                "skeletons.probes",
                                                                "commands.accepted",
                                                                "commands.refused",
                                                                "definitions",
                                                                "publish.errors",
                                                                "calibrations",
                                                                "adopted"};
  return kNames[static_cast<std::size_t>(count)];
}

/// One number for each Count. Add and Read from any thread.
class PostureCounters {
 public:
  void Add(Count count) {
    counts_[static_cast<std::size_t>(count)].fetch_add(1, std::memory_order_relaxed);
  }
  [[nodiscard]] std::uint64_t Read(Count count) const {
    return counts_[static_cast<std::size_t>(count)].load(std::memory_order_relaxed);
  }

 private:
  std::array<std::atomic<std::uint64_t>, kCountCount> counts_{};
};

}  // namespace limbcast::posture
