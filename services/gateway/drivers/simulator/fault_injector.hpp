#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/result.hpp"
#include "common/body/segment.hpp"
#include "common/sensing/marg_sample.hpp"
#include "common/sensing/sensor_info.hpp"
#include "common/simulation/random.hpp"

namespace limbcast::gateway {

/// What a bad sensor or link does to one sample.
enum class Fault : std::uint8_t {
  kNotFinite,   ///< NaN in the gyro or Inf in the accelerometer, in turns
  kSaturated,   ///< gyro and accelerometer at full scale, flagged
  kDuplicate,   ///< comes twice
  kOutOfOrder,  ///< comes after its successor, in the tick of that
  kGap,         ///< does not come, and neither do the next ones (gap_ticks in all)
  kMagMissing,  ///< without its magnetometer, flagged
};
inline constexpr std::size_t kFaultCount = 6;

/// The names of configuration: "not_finite", "saturated", "duplicate", "out_of_order", "gap",
/// "mag_missing".
[[nodiscard]] std::span<const std::pair<std::string_view, Fault>> FaultNames();

/// One fault at one place.
struct ListedFault {
  std::uint64_t tick = 0;  ///< counted from 0
  std::uint32_t body = 1;
  body::Segment segment = body::Segment::kPelvis;
  Fault fault = Fault::kNotFinite;
};

struct FaultConfig {
  /// Probability of each fault for every sample, by Fault. Range: [0, 1], all together too.
  std::array<double, kFaultCount> rate{};
  /// Range: [1, 100000].
  std::uint32_t gap_ticks = 5;
  std::vector<ListedFault> list;
};

[[nodiscard]] Status Validate(const FaultConfig& config);

/// Puts faults on the samples of one sensor. Thread-compatible; allocates nothing after
/// construction.
class FaultInjector {
 public:
  /// Takes from the list what is for this body and segment.
  FaultInjector(const FaultConfig& config, std::uint32_t body, body::Segment segment,
                const sensing::SensorInfo& info, const simulation::Random& random);

  /// Adds to `out` what becomes of `sample` (none, one or two samples, or a held one behind it).
  void Pass(std::uint64_t tick, const sensing::MargSample& sample,
            std::vector<sensing::MargSample>& out);

  /// The last sample was swallowed by a gap.
  [[nodiscard]] bool in_gap() const { return in_gap_; }
  /// How often each fault was put on, by Fault; kGap counts samples.
  [[nodiscard]] const std::array<std::uint64_t, kFaultCount>& counts() const { return counts_; }

 private:
  [[nodiscard]] std::optional<Fault> Draw(std::uint64_t tick);

  FaultConfig config_;
  bool any_ = false;
  sensing::SensorInfo info_;
  simulation::Random random_;
  std::size_t next_listed_ = 0;
  std::uint32_t gap_left_ = 0;
  bool in_gap_ = false;
  std::optional<sensing::MargSample> held_;
  std::array<std::uint64_t, kFaultCount> counts_{};
};

}  // namespace limbcast::gateway
