#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "common/base/result.hpp"
#include "common/base/tracking.hpp"
#include "common/base/verdict.hpp"
#include "common/sensing/marg_sample.hpp"

namespace limbcast::filters {

/// What an orientation filter knows after a sample. Earth frame: ENU, z up; heading as `heading`
/// says.
struct FilterEstimate {
  bool started = false;   ///< false: nothing below means anything yet
  bool degraded = false;  ///< bridging missing or unusable channels
  bool at_rest = false;
  MagneticState magnetic_state = MagneticState::kUnused;
  HeadingReference heading = HeadingReference::kArbitrary;
  Eigen::Quaterniond q_earth_sensor =
      Eigen::Quaterniond::Identity();  ///< sign continuous from sample to sample
  Eigen::Vector3d w_earth_sensor_in_sensor_rad_s = Eigen::Vector3d::Zero();  ///< bias removed
  Eigen::Vector3d free_accel_in_earth_m_s2 = Eigen::Vector3d::Zero();        ///< gravity removed
  Eigen::Vector3d gyro_bias_rad_s = Eigen::Vector3d::Zero();
  /// Covariance of the earth-frame rotation error; for filters without one, the honest equivalent
  /// they document.
  Eigen::Matrix3d cov_orientation_rad2 = Eigen::Matrix3d::Zero();
};

/// What a sample asks of a filter, beyond the sample gate.
enum class SampleStep : std::uint8_t {
  kNone,     ///< nothing: it is refused
  kPlain,    ///< one step of the filter's core
  kSpecial,  ///< a start, a bridged gap, the first field: what only the filter itself can do
};

class BatchedFilter;

/// One orientation filter for one sensor. Takes time with the sample: replay at any speed gives the
/// same answer. Opens nothing, logs nothing, allocates nothing after construction.
/// Thread-compatible.
class OrientationFilter {
 public:
  virtual ~OrientationFilter() = default;

  /// Takes the next sample; the verdict says what became of it. Never leaves a non-finite state
  /// behind.
  [[nodiscard]] virtual SampleVerdict Update(const sensing::MargSample& sample) = 0;

  [[nodiscard]] virtual const FilterEstimate& estimate() const = 0;

  /// This filter as one of several that are computed together, or null.
  [[nodiscard]] virtual BatchedFilter* batched() { return nullptr; }

  /// Back to the state after construction.
  virtual void Reset() = 0;

  /// Name in configuration and on the wire: "tqt", "ckf", "bmf", ... Static storage.
  [[nodiscard]] virtual std::string_view name() const = 0;

  /// Size of what SaveState writes.
  [[nodiscard]] virtual std::size_t state_size_bytes() const = 0;
  /// Writes the whole state; `out` has state_size_bytes(). Restoring it continues bit for bit.
  virtual void SaveState(std::span<std::byte> out) const = 0;
  /// Fails with kCorruptData and changes nothing when `in` is not a state of this filter and
  /// version.
  [[nodiscard]] virtual Status RestoreState(std::span<const std::byte> in) = 0;
};

/// A filter that shares its steps with others (filter_batches.hpp). Update does all at once; to
/// gain from the company, Submit the samples of several, run the batches, and Take each.
class BatchedFilter : public OrientationFilter {
 public:
  /// Takes the next sample. Nothing else but Take may be called before the batch has run.
  virtual void Submit(const sensing::MargSample& sample) = 0;
  /// After the batch has run: what became of the submitted sample.
  [[nodiscard]] virtual SampleVerdict Take() = 0;
  [[nodiscard]] BatchedFilter* batched() final { return this; }
};

}  // namespace limbcast::filters
