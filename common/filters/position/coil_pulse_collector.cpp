#include "common/filters/position/coil_pulse_collector.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

namespace limbcast::filters {

void CoilPulseCollector::Clear() {
  size_ = 0;
  before_size_ = before_next_ = 0;
  now_size_ = plateau_size_ = 0;
  coil_ = -1;
  tones_ = {};
  tone_background_tesla_.reset();
}

bool CoilPulseCollector::Update(const sensing::CoilFrame& frame, const CoilPath& path) {
  if (frame.drive.coil == sensing::kAllCoils) {
    return UpdateTones(frame, path);
  }
  const int coil = frame.drive.coil;
  bool finished = false;
  if (coil >= 0 && coil_ >= 0 && (coil != coil_ || now_size_ > plateau_size_)) {
    finished = Finish();
  }
  if (coil >= 0) {
    coil_ = coil;
  }
  if (!frame.HasField()) {
    return finished;
  }
  const Sample sample{frame.measured_at, coil >= 0 ? frame.drive.current_a : 0.0,
                      path.q_earth_sensor * frame.mag_tesla, path};
  if (coil_ < 0) {
    before_[before_next_] = sample;
    before_next_ = (before_next_ + 1) % kBackground;
    before_size_ = std::min(before_size_ + 1, kBackground);
    return finished;
  }
  if (now_size_ < kPlateau) {
    now_[now_size_++] = sample;
    plateau_size_ += coil >= 0 ? 1U : 0U;
  }
  if (coil < 0 && static_cast<int>(now_size_ - plateau_size_) >= background_after_) {
    finished = Finish();
  }
  return finished;
}

bool CoilPulseCollector::Finish() {
  const std::size_t plateau = plateau_size_;
  double n = 0.0;
  double mean_i = 0.0;
  const auto for_all = [&](const auto& use) {
    for (std::size_t k = 0; k < before_size_; ++k) {
      use(before_[k]);
    }
    for (std::size_t k = 0; k < now_size_; ++k) {
      use(now_[k]);
    }
  };
  for_all([&](const Sample& s) {
    n += 1.0;
    mean_i += s.current_a;
  });
  mean_i /= std::max(n, 1.0);
  double sum_ii = 0.0;
  Eigen::Vector3d sum_iy = Eigen::Vector3d::Zero();
  for_all([&](const Sample& s) {
    sum_ii += (s.current_a - mean_i) * (s.current_a - mean_i);
    sum_iy += (s.current_a - mean_i) * s.field_earth_tesla;
  });
  CollectedPulse pulse;
  pulse.coil = coil_;
  bool done = false;
  if (plateau >= 2 && sum_ii > 0.0) {
    const Sample& middle = now_[plateau / 2];
    pulse.current_a = std::abs(middle.current_a);
    pulse.field_earth_tesla = pulse.current_a / sum_ii * sum_iy;
    pulse.sigma_tesla = sigma_tesla_ * pulse.current_a / std::sqrt(sum_ii);
    pulse.middle_at = middle.at;
    pulse.path = middle.path;
    if (size_ == pulses_.size()) {
      std::rotate(pulses_.begin(), pulses_.begin() + 1, pulses_.end());
      --size_;
    }
    pulses_[size_++] = pulse;
    done = true;
  }
  // What came after this pulse came before the next.
  before_size_ = before_next_ = 0;
  for (std::size_t k = plateau; k < now_size_; ++k) {
    before_[before_next_] = now_[k];
    before_next_ = (before_next_ + 1) % kBackground;
    before_size_ = std::min(before_size_ + 1, kBackground);
  }
  now_size_ = plateau_size_ = 0;
  coil_ = -1;
  return done;
}

bool CoilPulseCollector::UpdateTones(const sensing::CoilFrame& frame, const CoilPath& path) {
  ToneWindow& w = tones_;
  if (w.samples == 0) {
    w.begun_at = w.middle_at = frame.measured_at;
    w.middle = path;
  }
  const double since_s = ToSeconds(frame.measured_at - w.begun_at);
  if (since_s <= 0.5 * tone_window_s_) {
    w.middle_at = frame.measured_at;
    w.middle = path;
  }
  if (frame.HasField()) {
    Eigen::Vector4d r;
    r << 1.0, frame.drive.tones_a / frame.drive.current_a;
    w.amplitude_a = frame.drive.current_a;
    w.A += r * r.transpose();
    w.b += r * (path.q_earth_sensor * frame.mag_tesla).transpose();
    ++w.samples;
  }
  if (since_s < tone_window_s_) {
    return false;
  }
  const ToneWindow whole = std::exchange(tones_, {});
  const Eigen::LDLT<Eigen::Matrix4d> solver(whole.A);
  constexpr double kLeastRcond = 1e-4;  // tones that cannot be told apart with what came
  if (whole.samples < 8 || !solver.isPositive() || solver.rcond() < kLeastRcond) {
    return false;
  }
  const Eigen::Matrix<double, 4, 3> a = solver.solve(whole.b);
  const Eigen::Vector4d variance = solver.solve(Eigen::Matrix4d::Identity()).diagonal();
  for (int coil = 0; coil < 3; ++coil) {
    CollectedPulse& pulse = pulses_[static_cast<std::size_t>(coil)];
    pulse.coil = coil;
    pulse.current_a = whole.amplitude_a;
    pulse.field_earth_tesla = a.row(coil + 1);
    pulse.sigma_tesla = sigma_tesla_ * std::sqrt(variance[coil + 1]);
    pulse.middle_at = whole.middle_at;
    pulse.path = whole.middle;
  }
  size_ = pulses_.size();
  tone_background_tesla_ = a.row(0);
  return true;
}

std::optional<std::array<CoilObservation, 3>> CoilPulseCollector::Burst() const {
  if (size_ < pulses_.size() || pulses_[0].coil == pulses_[1].coil ||
      pulses_[0].coil == pulses_[2].coil || pulses_[1].coil == pulses_[2].coil) {
    return std::nullopt;
  }
  const CollectedPulse& reference = pulses_[1];
  std::array<CoilObservation, 3> burst;
  for (std::size_t k = 0; k < burst.size(); ++k) {
    const CollectedPulse& pulse = pulses_[k];
    const Eigen::Matrix3d R_ES = pulse.path.q_earth_sensor.toRotationMatrix();
    const Eigen::Matrix3d R_EM_reference = reference.path.q_earth_emitter.toRotationMatrix();
    CoilObservation& o = burst[k];
    o.coil = pulse.coil;
    o.current_a = pulse.current_a;
    o.sigma_tesla = pulse.sigma_tesla;
    o.field_tesla = R_ES.transpose() * pulse.field_earth_tesla;
    o.R_pulse_reference_sensor =
        R_ES.transpose() * reference.path.q_earth_sensor.toRotationMatrix();
    o.R_reference_pulse_emitter =
        R_EM_reference.transpose() * pulse.path.q_earth_emitter.toRotationMatrix();
    o.dp_emitter_m = R_EM_reference.transpose() * (pulse.path.p_earth_m - reference.path.p_earth_m);
    o.time_from_reference_s = ToSeconds(pulse.middle_at - reference.middle_at);
  }
  return burst;
}

Eigen::Vector3d CoilPulseCollector::background_earth_tesla() const {
  if (tone_background_tesla_) {
    return *tone_background_tesla_;
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < before_size_; ++k) {
    sum += before_[k].field_earth_tesla;
  }
  return before_size_ > 0 ? Eigen::Vector3d(sum / static_cast<double>(before_size_)) : sum;
}

}  // namespace limbcast::filters
