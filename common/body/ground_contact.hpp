#pragma once

namespace limbcast::body {

/// When a point of the body counts as on the ground. The numbers are ours; the defaults suit
/// sensors at 50 Hz and more.
struct GroundContactConfig {
  /// A point comes into contact below this height over the lowest one, and leaves it above
  /// `height_off_m`. Errors of 2° in the orientations of a leg make heights wrong by 3 cm. Range:
  /// (0, 0.2], on < off.
  double height_on_m = 0.03;
  double height_off_m = 0.06;

  /// A point comes into contact when it moves along the ground slower than this against the point
  /// that is stood on, and leaves it when faster than `speed_off_m_s`. Range: (0, 2], on < off.
  double speed_on_m_s = 0.20;
  double speed_off_m_s = 0.35;

  /// Angular rate and free acceleration of a sensor, and height, that each count as an unrest of 1.
  /// > 0.
  double restless_rate_rad_s = 2.0;
  double restless_accel_m_s2 = 4.0;
  double restless_height_m = 0.03;

  /// Time constant over which rate and acceleration are smoothed, > 0.
  double smoothing_s = 0.04;
};

/// What the sensor and the pose say of a point in one frame.
struct GroundContactInput {
  double height_m = 0.0;    ///< over the lowest point of the person
  double rate_rad_s = 0.0;  ///< of the segment's sensor; 0 or not finite = not known
  double accel_m_s2 = 0.0;  ///< free acceleration of the sensor; 0 = not known
  double dt_s = 0.01;       ///< since the last frame, > 0
};

/// Whether one point of the body rests on the ground. Observe says how restless it is, which does
/// not depend on where the person is thought to be, so that a wrong belief cannot confirm itself;
/// Decide, once the point that is stood on has been chosen by that, whether this one rests too.
/// Thread-compatible.
class GroundContact {
 public:
  explicit GroundContact(const GroundContactConfig& config = {}) : config_(config) {}

  /// Takes one frame.
  void Observe(const GroundContactInput& input);
  ///   unrest = (h/h₀)² + mean of (ω/ω₀)² + (a/a₀)² over the last time constant
  [[nodiscard]] double unrest() const;

  /// @param speed_m_s  along the ground against the point that is stood on, smoothed.
  void Decide(double speed_m_s);
  void Reset();

  [[nodiscard]] bool touches() const { return touches_; }
  /// How much the point may be held fixed, 0 to 1; 0 when it does not touch. Falls smoothly as the
  /// point rises or moves, so that the ground is handed from one point to the next without a jump:
  ///   (1 − h/h_off)(1 − v/v_off) / (1 + unrest)
  [[nodiscard]] double trust() const { return trust_; }

 private:
  GroundContactConfig config_;
  double height_m_ = 0.0;
  double motion_ = 0.0;  // smoothed (ω/ω₀)² + (a/a₀)²
  bool touches_ = false;
  double trust_ = 0.0;
};

}  // namespace limbcast::body
