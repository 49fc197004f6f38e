#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace limbcast {

/// What became of one sample. Every sample that reaches the fusion service gets exactly one
/// verdict, and every verdict is counted: nothing is dropped silently. The numbers are part of the
/// wire contract: append only.
enum class SampleVerdict : std::uint8_t {
  kFused = 0,               ///< used as far as its valid parts go
  kPredictedOnly = 1,       ///< rate used, accelerometer and magnetometer gated or unusable
  kStarting = 2,            ///< used for the start average; no orientation yet
  kNoData = 3,              ///< a link probe, or every channel flagged missing
  kRejectedNotFinite = 4,   ///< NaN or Inf where a number is needed
  kRejectedDuplicate = 5,   ///< same sequence number or time as one already used
  kRejectedOutOfOrder = 6,  ///< older than the last one used
  kRejectedTime = 7,        ///< time that cannot be (far future, non-positive)
  kRejectedSaturated = 8,   ///< nothing usable was left after removing saturated channels
  kRejectedUnassigned = 9,  ///< no roster entry says which body and segment the sensor is on
  kRejectedOverload = 10,   ///< the queue to the worker was full
};
inline constexpr std::size_t kSampleVerdictCount = 11;

/// Lower-case name as in summaries, metrics and JSON: "fused", "rejected_duplicate", ...
[[nodiscard]] constexpr std::string_view ToString(SampleVerdict verdict) {
  constexpr std::array<std::string_view, kSampleVerdictCount> kNames = {
      "fused",        "predicted_only", "starting",  "no_data",    "not_finite", "duplicate",
      "out_of_order", "time",           "saturated", "unassigned", "overload"};
  const auto index = static_cast<std::size_t>(verdict);
  return index < kNames.size() ? kNames[index] : "unknown";
}

/// True when the sample moved the filter: fused, predicted or part of the start average.
[[nodiscard]] constexpr bool IsUsed(SampleVerdict verdict) {
  return static_cast<std::uint8_t>(verdict) <= static_cast<std::uint8_t>(SampleVerdict::kStarting);
}

/// One counter for each verdict, indexed by it. Thread-compatible.
struct VerdictCounters {
  std::array<std::uint64_t, kSampleVerdictCount> count{};

  void Add(SampleVerdict verdict) { ++count[static_cast<std::size_t>(verdict)]; }
  [[nodiscard]] std::uint64_t operator[](SampleVerdict verdict) const {
    return count[static_cast<std::size_t>(verdict)];
  }
  [[nodiscard]] std::uint64_t used() const { return count[0] + count[1] + count[2]; }
  [[nodiscard]] std::uint64_t refused() const {
    std::uint64_t sum = 0;
    for (std::size_t i = 3; i < count.size(); ++i) {
      sum += count[i];
    }
    return sum;
  }
  VerdictCounters& operator+=(const VerdictCounters& other) {
    for (std::size_t i = 0; i < count.size(); ++i) {
      count[i] += other.count[i];
    }
    return *this;
  }
  bool operator==(const VerdictCounters&) const = default;
};

}  // namespace limbcast
