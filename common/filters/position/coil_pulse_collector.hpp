#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <optional>

#include "common/filters/position/coil_observation.hpp"
#include "common/sensing/coil_frame.hpp"

namespace limbcast::filters {

/// Where the sensor and the emitter are by inertial dead reckoning when a sample is taken.
struct CoilPath {
  Eigen::Quaterniond q_earth_sensor = Eigen::Quaterniond::Identity();
  Eigen::Quaterniond q_earth_emitter = Eigen::Quaterniond::Identity();
  Eigen::Vector3d p_earth_m = Eigen::Vector3d::Zero();  ///< sensor minus emitter
};

/// One pulse: amplitude and where everything was in its middle.
struct CollectedPulse {
  int coil = -1;
  double current_a = 0.0;
  Eigen::Vector3d field_earth_tesla = Eigen::Vector3d::Zero();
  double sigma_tesla = 0.0;
  Time middle_at{};
  CoilPath path;
};

/// Takes pulses out of magnetometer samples with the background removed by gyro
/// (design/position.md section 7): every sample, in the pulse and before and after it, is turned to
/// the earth frame by the dead-reckoned attitude, and the amplitude is the slope of
///
///   R_s y = m + a i :   a = Σ (i − ī) R_s y / Σ (i − ī)² ,   σ_a² = σ² / Σ (i − ī)²
///
/// which is mean minus mean for a unipolar pulse and half the difference for a bipolar one. Keeps
/// the last three pulses.
///
/// Tones (CoilTones) are three pulses at once: over a window,
///
///   R_s y = m + Σ_c a_c i_c   by least squares ,  σ_ac² = σ² (Σ r rᵀ)⁻¹_cc ,  r = [1, i_x, i_y,
///   i_z]
///
/// with currents in amplitudes, and the path in the middle of the window. Fixed size;
/// thread-compatible.
class CoilPulseCollector {
 public:
  /// `background_after` of who cannot wait (design/position.md section 7).
  static constexpr int kBackgroundAfterLive = 3;

  /// @param background_after  a pulse is done after so many background samples, or with the next.
  /// @param tone_window_s     with tones, a window of so long is three pulses.
  CoilPulseCollector(double sigma_tesla, int background_after, double tone_window_s = 0.2)
      : sigma_tesla_(sigma_tesla),
        background_after_(background_after),
        tone_window_s_(tone_window_s) {}

  void Clear();
  /// Returns true when a pulse has just been completed. A pulse of which a sample is clipped is
  /// taken from the others; one with fewer than two is dropped.
  bool Update(const sensing::CoilFrame& frame, const CoilPath& path);

  [[nodiscard]] std::size_t size() const { return size_; }
  /// The last pulses, oldest first; size() of them.
  [[nodiscard]] const std::array<CollectedPulse, 3>& pulses() const { return pulses_; }
  [[nodiscard]] const CollectedPulse& newest() const { return pulses_[size_ - 1]; }
  /// The three pulses as observations at the middle of the second. None until there are three, one
  /// of each coil.
  [[nodiscard]] std::optional<std::array<CoilObservation, 3>> Burst() const;
  /// The latest mean of the background in the earth frame, with tones that of their last window;
  /// zero when there was none.
  [[nodiscard]] Eigen::Vector3d background_earth_tesla() const;

 private:
  static constexpr std::size_t kBackground = 10;  // samples before a pulse
  static constexpr std::size_t kPlateau = 64;     // samples of one

  struct Sample {
    Time at{};
    double current_a = 0.0;
    Eigen::Vector3d field_earth_tesla = Eigen::Vector3d::Zero();
    CoilPath path;
  };

  bool Finish();
  bool UpdateTones(const sensing::CoilFrame& frame, const CoilPath& path);

  // Normal equations of a window of tones.
  struct ToneWindow {
    int samples = 0;
    Time begun_at{};
    double amplitude_a = 0.0;
    Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
    Eigen::Matrix<double, 4, 3> b = Eigen::Matrix<double, 4, 3>::Zero();
    Time middle_at{};
    CoilPath middle;
  };

  double sigma_tesla_;
  int background_after_;
  double tone_window_s_;
  ToneWindow tones_;
  std::optional<Eigen::Vector3d> tone_background_tesla_;
  std::array<CollectedPulse, 3> pulses_{};
  std::size_t size_ = 0;
  std::array<Sample, kBackground> before_{};
  std::size_t before_size_ = 0;
  std::size_t before_next_ = 0;
  std::array<Sample, kPlateau> now_{};  // plateau of the pulse, then the background after it
  std::size_t now_size_ = 0;
  std::size_t plateau_size_ = 0;
  int coil_ = -1;
};

}  // namespace limbcast::filters
