#include "tools/limbcast/evaluate/coil_endurance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "common/base/expects.hpp"
#include "common/filters/position/coil_inertial_filter.hpp"
#include "common/simulation/random.hpp"
#include "common/simulation/smooth_step.hpp"
#include "tools/limbcast/evaluate/coil_trial.hpp"
#include "tools/limbcast/evaluate/parallel.hpp"

namespace limbcast::tool {
namespace {

using simulation::Jet;
using simulation::Random;
using simulation::RigidMotion;

constexpr double kStill_s = 2.5;
constexpr double kScoredFrom_s = 5.0;
constexpr double kPatience_s = 2.0;  // to be right again after a loss
constexpr double kOffFor_s = 1.0;

// Two sines that share an amplitude.
struct Swing {
  double amplitude = 0.0;
  std::array<double, 2> rate_rad_s{};
  std::array<double, 2> at_rad{};

  Swing(Random& random, double least, double most, double fastest_hz)
      : amplitude(random.Uniform(least, most)) {
    for (std::size_t i = 0; i < 2; ++i) {
      rate_rad_s[i] = 2.0 * std::numbers::pi * random.Uniform(0.15, fastest_hz);
      at_rad[i] = random.Uniform(0.0, 2.0 * std::numbers::pi);
    }
  }
  [[nodiscard]] Jet At(const Jet& t) const {
    return (0.5 * amplitude) * (simulation::Sin(rate_rad_s[0] * t + at_rad[0]) +
                                simulation::Sin(rate_rad_s[1] * t + at_rad[1]));
  }
};

struct Limb {
  bool moving_source;
  std::array<Swing, 3> sway_m;
  std::array<Swing, 3> pelvis_rad;
  std::array<Swing, 2> shoulder_rad;
  std::array<Swing, 2> elbow_rad;
  std::array<Swing, 3> wrist_rad;
  double heading_rad;
  double swell_s;
  Eigen::Vector3d p_shoulder_m;
  Eigen::Vector3d p_elbow_m;
  Eigen::Vector3d p_sensor_m;

  explicit Limb(Random& random)
      : moving_source(random.Uniform() < 0.75),
        sway_m{Swing(random, 0.0, 0.06, 0.8), Swing(random, 0.0, 0.06, 0.8),
               Swing(random, 0.0, 0.04, 0.8)},
        pelvis_rad{Swing(random, 0.0, 0.2, 0.6), Swing(random, 0.0, 0.2, 0.6),
                   Swing(random, 0.0, 0.6, 0.4)},
        shoulder_rad{Swing(random, 0.2, 0.6, 1.0), Swing(random, 0.2, 0.6, 1.0)},
        elbow_rad{Swing(random, 0.2, 0.6, 1.2), Swing(random, 0.2, 0.6, 1.2)},
        wrist_rad{Swing(random, 0.1, 1.0, 1.0), Swing(random, 0.1, 1.0, 1.0),
                  Swing(random, 0.1, 1.5, 1.0)},
        heading_rad(random.Uniform(-std::numbers::pi, std::numbers::pi)),
        swell_s(random.Uniform(60.0, 120.0)),
        p_shoulder_m(random.Uniform(-0.05, 0.05), random.Uniform(-0.05, 0.05),
                     random.Uniform(0.08, 0.14)),
        p_elbow_m(0.0, 0.0, random.Uniform(0.04, 0.18)),
        p_sensor_m(0.0, 0.0, random.Uniform(0.04, 0.22)) {}

  [[nodiscard]] Jet Strength(const Jet& t) const {
    const Jet swell =
        0.55 + 0.45 * simulation::Cos(2.0 * std::numbers::pi / swell_s * (t - kStill_s - 8.0));
    return simulation::SmoothStep(t, kStill_s, kStill_s + 1.5) * swell;
  }
  [[nodiscard]] RigidMotion Emitter(double t_s) const {
    const Jet t = Jet::Variable(t_s);
    const Jet on = moving_source ? Strength(t) : Jet(0.0);
    RigidMotion motion = simulation::MovingPoint(
        {on * sway_m[0].At(t), on * sway_m[1].At(t), 1.0 + on * sway_m[2].At(t)});
    simulation::RotateAbout(motion, 2, heading_rad + on * pelvis_rad[2].At(t));
    simulation::RotateAbout(motion, 1, on * pelvis_rad[1].At(t));
    simulation::RotateAbout(motion, 0, on * pelvis_rad[0].At(t));
    return motion;
  }
  [[nodiscard]] RigidMotion Sensor(double t_s) const {
    const Jet t = Jet::Variable(t_s);
    const Jet on = Strength(t);
    RigidMotion motion = simulation::AtPoint(Emitter(t_s), p_shoulder_m);
    simulation::RotateAbout(motion, 0, on * shoulder_rad[0].At(t));
    simulation::RotateAbout(motion, 1, on * shoulder_rad[1].At(t));
    motion = simulation::AtPoint(motion, p_elbow_m);
    simulation::RotateAbout(motion, 0, on * elbow_rad[0].At(t));
    simulation::RotateAbout(motion, 1, on * elbow_rad[1].At(t));
    motion = simulation::AtPoint(motion, p_sensor_m);
    for (int axis = 0; axis < 3; ++axis) {
      simulation::RotateAbout(motion, axis, on * wrist_rad[static_cast<std::size_t>(axis)].At(t));
    }
    return motion;
  }
};

// Takes track away, again and again, and waits for it.
class Loser {
 public:
  Loser(std::uint64_t seed, double every_s)
      : random_(seed, "losses"), every_s_(every_s), next_s_(kScoredFrom_s + 3.0) {}

  /// Before a frame is used.
  void Spoil(double t_s, sensing::CoilFrame& frame) {
    if (t_s >= spoilt_until_s_) {
      return;
    }
    if (kind_ == Kind::kSilence) {
      frame.mag_valid = false;
    } else {
      frame.mag_tesla = 5e-5 * random_.Gaussian3();
    }
  }
  /// After it.
  void Inject(double t_s, filters::CoilInertialFilter& filter) {
    if (every_s_ <= 0.0 || t_s < next_s_ || filter.phase() != filters::CoilPhase::kTracking) {
      return;
    }
    next_s_ = t_s + every_s_;
    waiting_ = true;
    right_again_from_s_ = t_s;
    kind_ = static_cast<Kind>(count_++ % 4);
    filters::CoilVector kick = filters::CoilVector::Zero();
    switch (kind_) {
      case Kind::kKick:
        kick.segment<3>(filters::CoilInertialIndex::kP) = 0.3 * random_.Gaussian3();
        kick.segment<3>(filters::CoilInertialIndex::kV) = 0.5 * random_.Gaussian3();
        filter.Disturb(kick);
        break;
      case Kind::kMirror:
        kick.segment<3>(filters::CoilInertialIndex::kP) = -1.8 * filter.state().p_earth_m;
        filter.Disturb(kick);
        break;
      case Kind::kSilence:
        spoilt_until_s_ = right_again_from_s_ = t_s + 3.0;
        break;
      case Kind::kNonsense:
        spoilt_until_s_ = right_again_from_s_ = t_s + 1.0;
        break;
    }
  }
  /// True until the filter is right again for good, as far as this loss is concerned.
  bool Waits(double t_s, bool right, CoilEndurance& result) {
    if (!waiting_ || t_s < right_again_from_s_) {
      return waiting_;
    }
    if (counted_) {  // late, and counted so: until it is back
      waiting_ = !right;
      counted_ = waiting_;
      return waiting_;
    }
    wrong_at_s_ = right ? wrong_at_s_ : t_s;
    // Settled when nothing was wrong for half a second.
    if (t_s - std::max(wrong_at_s_, right_again_from_s_) < 0.5 &&
        t_s - right_again_from_s_ < kPatience_s + 0.5) {
      return true;
    }
    const double took_s = std::max(0.0, wrong_at_s_ - right_again_from_s_);
    const bool late = took_s > kPatience_s;
    if (kind_ == Kind::kMirror) {
      result.mirrored_late += late ? 1 : 0;
      ++result.mirrored;
    } else {
      result.slowest_s = std::max(result.slowest_s, took_s);
      result.late += late ? 1 : 0;
      ++result.injected;
    }
    counted_ = waiting_ = kind_ == Kind::kMirror && late && !right;
    return waiting_;
  }

 private:
  enum class Kind : std::uint8_t { kKick, kMirror, kSilence, kNonsense };

  Random random_;
  double every_s_;
  double next_s_;
  Kind kind_ = Kind::kKick;
  int count_ = 0;
  bool waiting_ = false;
  bool counted_ = false;
  double spoilt_until_s_ = 0.0;
  double right_again_from_s_ = 0.0;
  double wrong_at_s_ = 0.0;
};

}  // namespace

CoilSubject MakeCoilSubject(std::uint64_t seed) {
  Random random(seed, "coil subject");
  const Limb limb(random);
  CoilSubject subject;
  const CoilNoise noise = seed % 2 == 1 ? CoilNoise::kModern : CoilNoise::kThesis;
  const double sigma_tesla = SigmaOf_tesla(noise);
  subject.stream.pulses = PulsesOf(noise);
  subject.stream.sensor = [limb](double t_s) { return limb.Sensor(t_s); };
  subject.stream.emitter = [limb](double t_s) { return limb.Emitter(t_s); };
  subject.stream.emitter_inertial = limb.moving_source;
  subject.stream.errors = simulation::CoilSensorErrors(sigma_tesla);
  subject.stream.gradient_tesla_m = DrawGradient_tesla_m(random);
  subject.filter.source = subject.stream.source;
  subject.filter.sigma_mag_tesla = sigma_tesla;
  subject.filter.half_space = Eigen::Vector3d::UnitZ();
  return subject;
}

CoilEndurance operator+(const CoilEndurance& a, const CoilEndurance& b) {
  CoilEndurance sum = a;
  sum.hours += b.hours;
  sum.runs += b.runs;
  sum.diverged += b.diverged;
  sum.flips += b.flips;
  sum.losses += b.losses;
  sum.injected += b.injected;
  sum.late += b.late;
  sum.mirrored += b.mirrored;
  sum.mirrored_late += b.mirrored_late;
  sum.slowest_s = std::max(a.slowest_s, b.slowest_s);
  if (sum.hours > 0.0) {
    sum.rms_m = std::sqrt((a.hours * a.rms_m * a.rms_m + b.hours * b.rms_m * b.rms_m) / sum.hours);
  }
  return sum;
}

CoilEndurance RunCoilSubject(std::uint64_t seed, double duration_s, double loss_every_s,
                             const std::function<void(double)>& progress) {
  CoilSubject subject = MakeCoilSubject(seed);
  const double rate_hz = subject.stream.rate_hz;
  auto filter = filters::CoilInertialFilter::Make(subject.filter);
  Expects(filter.ok(), "the configuration of a subject");
  simulation::CoilStream stream(std::move(subject.stream), seed);
  Loser loser(seed, loss_every_s);
  CoilEndurance result;
  result.runs = 1;
  double off_s = 0.0;
  double gone_s = 0.0;
  double sum_m2 = 0.0;
  std::int64_t scored = 0;
  const auto ticks = static_cast<std::int64_t>(duration_s * rate_hz);
  for (std::int64_t k = 0; k < ticks; ++k) {
    simulation::CoilTick tick = stream.Next();
    const double t_s = static_cast<double>(k) / rate_hz;
    loser.Spoil(t_s, tick.frame);
    filter->Update(tick.frame);
    if (!filter->state().IsFinite()) {
      result.diverged = 1;
      break;
    }
    if (t_s < kScoredFrom_s) {
      continue;
    }
    const Eigen::Vector3d p_m = filter->state().p_emitter_sensor_m();
    const double error_m = (p_m - tick.p_emitter_sensor_m).norm();
    const bool tracking = filter->phase() == filters::CoilPhase::kTracking;
    const bool right = tracking && error_m < 0.05 + 0.1 * tick.p_emitter_sensor_m.norm();
    if (!loser.Waits(t_s, right, result)) {
      result.flips += tracking && p_m.dot(tick.p_emitter_sensor_m) < 0.0 ? 1 : 0;
      off_s = tracking && !right ? off_s + 1.0 / rate_hz : 0.0;
      gone_s = tracking ? 0.0 : gone_s + 1.0 / rate_hz;
      if (off_s > kOffFor_s || gone_s > kPatience_s) {
        result.diverged = 1;
      }
      sum_m2 += tracking ? error_m * error_m : 0.0;
      scored += tracking ? 1 : 0;
      loser.Inject(t_s, *filter);
    }
    if (progress && k % 100'000 == 0) {
      progress(t_s);
    }
  }
  result.losses = filter->losses();
  result.hours = std::max(0.0, duration_s - kScoredFrom_s) / 3600.0;
  result.rms_m = std::sqrt(sum_m2 / static_cast<double>(std::max<std::int64_t>(scored, 1)));
  return result;
}

CoilEndurance RunCoilSubjects(std::uint64_t first_seed, int count,
                              const std::function<void(int)>& progress) {
  constexpr double kRun_s = 20.0;
  constexpr double kLossEvery_s = 6.0;
  std::vector<CoilEndurance> runs(static_cast<std::size_t>(count));
  std::mutex telling;
  int done = 0;
  ForEachIndex(runs.size(), [&](std::size_t i) {
    runs[i] = RunCoilSubject(first_seed + i, kRun_s, i / 2 % 2 == 0 ? 0.0 : kLossEvery_s);
    const std::scoped_lock lock(telling);
    ++done;
    if (progress) {
      progress(done);
    }
  });
  return std::accumulate(runs.begin(), runs.end(), CoilEndurance());
}

}  // namespace limbcast::tool
