#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "common/filters/attitude_watchdog.hpp"
#include "common/filters/bounded_motion_core.hpp"
#include "common/filters/filter.hpp"
#include "common/filters/sample_gate.hpp"
#include "common/filters/two_vector_start.hpp"

namespace limbcast::filters {

/// The bounded-motion filter ("bmf"): a multi-rate error-state Kalman filter that is accurate
/// because it
///
/// - knows that a worn sensor stays in a bounded region, so that weak zero-velocity and
/// zero-position measurements turn
///   the accelerometer into an optimally low-passed inclination reference;
/// - learns the gyro's scale and misalignment on line;
/// - takes a field carried with the sensor for what it is;
/// - guards heading against a distorted field: the reference field is a state, and the magnetometer
/// counts by how well
///   the field agrees with it.
///
/// This class adds time stamps, start, gaps and bad input to BoundedMotionCore. Thread-compatible;
/// allocates nothing after construction.
template <typename Scalar>
class BoundedMotionFilter final : public OrientationFilter {
 public:
  /// @param config  valid.
  /// @param name    static storage: "bmf" or "bmf-plain".
  explicit BoundedMotionFilter(const BoundedMotionConfig& config, std::string_view name = "bmf");

  [[nodiscard]] SampleVerdict Update(const sensing::MargSample& sample) override;
  [[nodiscard]] const FilterEstimate& estimate() const override { return state_.estimate; }
  void Reset() override;
  [[nodiscard]] std::string_view name() const override { return name_; }
  [[nodiscard]] std::size_t state_size_bytes() const override;
  void SaveState(std::span<std::byte> out) const override;
  [[nodiscard]] Status RestoreState(std::span<const std::byte> in) override;

  [[nodiscard]] const BoundedMotionCore<Scalar>& core() const { return core_; }

  using Config = BoundedMotionConfig;
  using Number = Scalar;
  using CoreInput = BoundedMotionInput<Scalar>;
  using CoreState = BoundedMotionState<Scalar>;

  /// Update in parts, for a batch that steps the core of several filters at once; as in
  /// GaussNewtonOrientation.
  [[nodiscard]] SampleStep Pass(const sensing::MargSample& sample);
  [[nodiscard]] const CoreInput& core_input() const { return input_; }
  SampleVerdict StepAlone();
  /// After none.
  [[nodiscard]] SampleVerdict refusal() const { return gated_.verdict; }
  SampleVerdict Report();

  [[nodiscard]] const Config& config() const { return core_.config(); }
  [[nodiscard]] CoreState& core_state() { return core_.mutable_state(); }
  /// See BoundedMotionCore.
  void LendCoreState(CoreState& place) { core_.LendState(place); }
  template <typename Copy>
  static void ForEachPassed(CoreState& core, Copy copy) {
    copy(core.has_field);
  }
  template <typename Copy>
  static void ForEachReported(CoreState& core, Copy copy) {
    copy(core.has_field);
    copy(core.q_ES);
    copy(core.w_ES_S);
    copy(core.rest_time_s);
    copy(core.b_g);
    copy(core.b_a);
    copy(core.deviation_hold);
    for (int column = 0; column < 3; ++column) {
      for (int row = 0; row <= column; ++row) {
        copy(core.P(row, column));
      }
    }
  }

 private:
  using Vector3 = Eigen::Matrix<Scalar, 3, 1>;

  struct State {
    FilterEstimate estimate;
    SampleGate gate;
    TwoVectorStart start;
    AttitudeWatchdog watchdog;
    Eigen::Vector3d reference_tesla = Eigen::Vector3d::Zero();  // field of the start: north, up
    double heading_before_rad = 0.0;                            // of a restart
    bool starting = true;
    bool lost = false;  // the restart under way forgets what was learned
  };
  struct Saved {
    State state;
    BoundedMotionState<Scalar> core;
  };

  void BeginRestart();
  void CheckAttitude();
  SampleVerdict UpdateStart();
  void Feed();
  void AdoptField(const Eigen::Vector3d& mag_in_earth_tesla);
  [[nodiscard]] Eigen::Vector3d ReferenceFor(const Eigen::Vector3d& mag_in_earth_tesla) const;
  void DoubtHeading(const Eigen::Vector3d& mag_in_earth_tesla);

  BoundedMotionCore<Scalar> core_;
  std::string_view name_;
  State state_;
  GatedSample gated_;  // the one in work
  CoreInput input_;
};

extern template class BoundedMotionFilter<double>;
extern template class BoundedMotionFilter<float>;

/// A BoundedMotionFilter in the precision that `config` asks for.
[[nodiscard]] std::unique_ptr<OrientationFilter> MakeBoundedMotionFilter(
    const BoundedMotionConfig& config, std::string_view name);

}  // namespace limbcast::filters
