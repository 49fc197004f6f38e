#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "common/base/verdict.hpp"
#include "common/sensing/marg_sample.hpp"

namespace limbcast::filters {

/// A reading after the bad-input rules that all filters share (design/orientation.md section 6).
struct GatedSample {
  SampleVerdict verdict = SampleVerdict::kNoData;  ///< kFused: usable; otherwise why not
  double dt_s = 0.0;     ///< since the last used sample; 0 for the first one
  bool restart = false;  ///< first sample, or a gap too long to bridge
  bool gap = false;      ///< a gap short enough to bridge: gyro_rad_s is the mean rate over it
  Eigen::Vector3d gyro_rad_s = Eigen::Vector3d::Zero();  ///< measured, held or zero
  bool gyro_measured = false;                            ///< gyro_rad_s is a reading of this sample
  bool gyro_held = false;       ///< it is the last reading, at most kMaxGyroHold_s old
  bool gyro_saturated = false;  ///< the true rate is higher
  bool accel_valid = false;
  Eigen::Vector3d accel_m_s2 = Eigen::Vector3d::Zero();
  bool mag_valid = false;
  Eigen::Vector3d mag_tesla = Eigen::Vector3d::Zero();

  [[nodiscard]] bool usable() const { return verdict == SampleVerdict::kFused; }
  /// The gyro is bridged or gone.
  [[nodiscard]] bool gyro_absent() const { return !gyro_measured; }
};

/// What SampleGate remembers; copied as bytes when a filter saves its state.
struct SampleGateState {
  std::int64_t last_ns = 0;
  std::int64_t rejected_ns = 0;  // newest of a run of samples that were too old
  Eigen::Vector3d last_gyro_rad_s = Eigen::Vector3d::Zero();
  double nominal_dt_s = 0.0;
  double gyro_absent_s = 0.0;
  double mag_absent_s = 0.0;
  std::uint32_t steps = 0;         // of the average behind nominal_dt_s, saturating
  std::uint32_t rejected_run = 0;  // consecutive samples older than last_ns
  bool has_time = false;
  bool gyro_seen = false;
  bool mag_seen = false;
};

/// Decides which parts of a sample can be used, and bridges what is missing. A refused sample
/// leaves the filter as it was. Time that jumps back is refused, until so many samples agree on the
/// new time that the old one must have been wrong: there is always a way back. Thread-compatible.
class SampleGate {
 public:
  [[nodiscard]] GatedSample Pass(const sensing::MargSample& sample) {
    GatedSample out;
    Pass(sample, out);
    return out;
  }
  /// The same into a place that is there already.
  void Pass(const sensing::MargSample& sample, GatedSample& out);

  /// Time without a usable magnetometer reading; infinite when there never was one.
  [[nodiscard]] double mag_absent_s() const;
  /// The sensor delivered a gyro reading at some time.
  [[nodiscard]] bool gyro_seen() const { return state_.gyro_seen; }

  [[nodiscard]] const SampleGateState& state() const { return state_; }
  [[nodiscard]] SampleGateState& mutable_state() { return state_; }

 private:
  [[nodiscard]] SampleVerdict CheckTime(std::int64_t now_ns, GatedSample& out);
  void FillGyro(bool measured, const Eigen::Vector3d& gyro_rad_s, GatedSample& out);
  void LearnNominal(double dt_s, bool gap);

  SampleGateState state_;
};

}  // namespace limbcast::filters
