#include "tools/limbcast/evaluate/published_experiments.hpp"

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "common/math/rotation.hpp"
#include "common/simulation/arm_motion.hpp"
#include "common/simulation/iron_object.hpp"
#include "common/simulation/low_pass.hpp"
#include "common/simulation/smooth_step.hpp"
#include "common/units/units.hpp"

namespace limbcast::tool {
namespace {

using simulation::Jet;
using simulation::Jet3;
using units::RadFromDeg;

constexpr double kRate_hz = 100.0;
constexpr int kOversampling = 4;  // the filters in front of the converters run this much faster
constexpr double kStill_s = 3.0;  // every trial begins with it [section 3.2.2]
constexpr double kNorth_rad = 0.5 * std::numbers::pi;  // from the x axis (east)

// Moment that iron keeps, by its mass; not printed. Chosen so that the filter without compensation
// errs by the 40° of section 2.4 at 5 cm; the figures with compensation are then predictions.
constexpr double kPermanent_a_m2_kg = 0.02;
// The same for the sheet of the case: the 13.1° of section 3.3.
constexpr double kCaseRemanence_a_m = 2.5e4;

// A ball of iron `gap_m` from the module, on the line to `towards`, that comes and goes: the share
// of the way from 2 m off.
struct MovingIron {
  double mass_kg = 0.0;
  Eigen::Vector3d p_earth_module_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d towards = Eigen::Vector3d::UnitX();
  double gap_m = 0.05;
  Eigen::Vector3d permanent_a_m2 = Eigen::Vector3d::Zero();

  static MovingIron Make(double mass_kg, const Eigen::Vector3d& p_earth_module_m, double gap_m,
                         const Eigen::Vector3d& towards, simulation::Random& random) {
    return {.mass_kg = mass_kg,
            .p_earth_module_m = p_earth_module_m,
            .towards = towards,
            .gap_m = gap_m,
            .permanent_a_m2 = kPermanent_a_m2_kg * mass_kg * random.Gaussian3().normalized()};
  }
  [[nodiscard]] simulation::MagneticWorld World(double presence) const {
    constexpr double kAway_m = 2.0;
    simulation::MagneticWorld world;
    const double distance_m =
        simulation::IronBallRadius_m(mass_kg) + gap_m + (1.0 - presence) * kAway_m;
    world.iron.push_back(simulation::MakeIronBall(mass_kg, p_earth_module_m + distance_m * towards,
                                                  permanent_a_m2, world.earth));
    return world;
  }
};

Eigen::Vector3d HorizontalDirection(simulation::Random& random) {
  const double bearing_rad = random.Uniform(-std::numbers::pi, std::numbers::pi);
  return {std::cos(bearing_rad), std::sin(bearing_rad), 0.0};
}

// A turn by `angle_rad` about one axis between two times.
struct Turn {
  int axis = 0;
  double angle_rad = 0.0;
  double from_s = 0.0;
  double to_s = 0.0;
};

// There and back about three axes with rests of 3 s, all angles times `sign`.
void AppendTurns(std::vector<Turn>& turns, double& t_s, std::initializer_list<int> axes,
                 double sign) {
  constexpr double kTurn_s = 1.0;
  constexpr double kRest_s = 3.0;
  constexpr std::array<double, 3> kFirst = {1.0, -1.0, 1.0};  // x: +90 −90, y: −90 +90, z: +90 −90
  for (const int axis : axes) {
    for (const double way : {1.0, -1.0}) {
      turns.push_back(
          {.axis = axis,
           .angle_rad = sign * way * kFirst[static_cast<std::size_t>(axis)] * kNorth_rad,
           .from_s = t_s,
           .to_s = t_s + kTurn_s});
      t_s += kTurn_s + kRest_s;
    }
  }
}

// The turns are made one after the other in the sensor's own axes.
simulation::RigidMotion TurnedBy(const std::vector<Turn>& turns, const Jet3& p_earth_m,
                                 double t_s) {
  simulation::RigidMotion frame = simulation::MovingPoint(p_earth_m);
  simulation::RotateAbout(frame, 2, kNorth_rad);
  for (const Turn& turn : turns) {
    simulation::RotateAbout(
        frame, turn.axis,
        turn.angle_rad * simulation::SmoothStep(Jet::Variable(t_s), turn.from_s, turn.to_s));
  }
  return frame;
}

// (1 − cos 2πft)/2 from `from_s` on, for whole periods.
Jet Swing(double t_s, double frequency_hz, double from_s, int periods) {
  if (t_s <= from_s || t_s >= from_s + periods / frequency_hz) {
    return {};
  }
  const Jet phase = 2.0 * std::numbers::pi * frequency_hz * (Jet::Variable(t_s) - from_s);
  return 0.5 * (1.0 - simulation::Cos(phase));
}

// A person in front of the case: way to it, and how the person faces.
struct Subject {
  double heading_rad = 0.0;
  std::vector<std::pair<double, double>> away_s;  // not at the case between these times
  std::vector<simulation::IronZone> iron;

  static Subject Make(bool near_case, simulation::Random& random) {
    Subject subject;
    // The edges of the case are those of the earth axes: the person faces one of its long sides.
    subject.heading_rad = random.Uniform() < 0.5 ? 0.0 : std::numbers::pi;
    if (near_case) {
      simulation::IronCase box;
      box.size_m = {0.35, 0.70, 0.90};
      box.p_earth_center_m = {std::cos(subject.heading_rad) * 0.55, 0.0, 0.45};
      box.remanence_a_m = kCaseRemanence_a_m;
      subject.iron = simulation::MakeIronCase(box, {}, random);
    }
    return subject;
  }
  // The shoulder: 1.5 m back at first, then at the case.
  [[nodiscard]] Jet3 Shoulder(double t_s) const {
    constexpr double kStep_s = 1.5;
    constexpr double kHeight_m = 1.40;
    const Jet t = Jet::Variable(t_s);
    Jet back_m = 1.5 * (1.0 - simulation::SmoothStep(t, kStill_s + 0.5, kStill_s + 0.5 + kStep_s));
    for (const auto& [from_s, to_s] : away_s) {
      back_m += simulation::Window(t, from_s, to_s, kStep_s);
    }
    const double c = std::cos(heading_rad);
    const double s = std::sin(heading_rad);
    return {-c * back_m, -s * back_m, kHeight_m};
  }
};

// A wave between −1 and 1 that grows from 0 at the begin of the movement.
Jet Wave(double t_s, double frequency_hz, double phase_rad) {
  constexpr double kBegin_s = kStill_s + 2.5;
  const Jet t = Jet::Variable(t_s);
  return simulation::SmoothStep(t, kBegin_s, kBegin_s + 2.0) *
         simulation::Sin(2.0 * std::numbers::pi * frequency_hz * t + phase_rad);
}

std::function<ExperimentPart(double)> WholeMovement(ExperimentPart part) {
  return [part](double t_s) { return t_s < kStill_s ? ExperimentPart::kNotScored : part; };
}

}  // namespace

simulation::MargErrors ThesisSensorErrors() {
  constexpr double kBits16 = 1.0 / 32768.0;
  const double gyro_range_rad_s = RadFromDeg(900.0);
  simulation::MargErrors errors;
  errors.gyro = {.noise_rthz = RadFromDeg(0.05),
                 .bias = RadFromDeg(0.3),
                 .bias_walk_rts = RadFromDeg(0.01),
                 .bias_per_celsius = RadFromDeg(0.01),
                 .scale = 0.005,
                 .misalignment = 0.005,
                 .range = gyro_range_rad_s,
                 .resolution = gyro_range_rad_s * kBits16};
  errors.accel = {.noise_rthz = 0.2e-3 * simulation::kGravity_m_s2,
                  .bias = 0.02,
                  .bias_walk_rts = 1e-4,
                  .scale = 0.003,
                  .misalignment = 0.003,
                  .range = 50.0,
                  .resolution = 50.0 * kBits16};
  errors.mag = {.noise = 0.05e-6,
                .bias = 0.2e-6,
                .scale = 0.005,
                .misalignment = 0.003,
                .range = 200e-6,
                .resolution = 200e-6 * kBits16};
  errors.warm_up_celsius = 5.0;
  return errors;
}

SimulatedTrial Simulate(const std::string& name, const ExperimentPlan& plan,
                        const simulation::Random& random) {
  const double fast_hz = kRate_hz * kOversampling;
  simulation::LowPass gyro(50.0, fast_hz);
  simulation::LowPass accel(10.0, fast_hz);
  simulation::LowPass mag(10.0, fast_hz);
  simulation::MargModel model(ThesisSensorErrors(), kRate_hz, random);
  SimulatedTrial made;
  made.trial.name = name;
  Eigen::Vector3f offset_rad_s = Eigen::Vector3f::Zero();
  const auto offset_rows = static_cast<std::size_t>(plan.offset_time_s * kRate_hz);
  const auto rows = static_cast<std::int64_t>(plan.duration_s * kRate_hz);
  for (std::int64_t row = 0; row < rows; ++row) {
    simulation::IdealMarg read;
    double t_s = 0.0;
    for (int step = 1 - kOversampling; step <= 0; ++step) {
      t_s = std::max(0.0, static_cast<double>(row) / kRate_hz + step / fast_hz);
      read = simulation::MakeIdealMarg(plan.motion(t_s), {}, plan.world(t_s));
      read.gyro_rad_s = gyro.Filter(read.gyro_rad_s);
      read.accel_m_s2 = accel.Filter(read.accel_m_s2);
      read.mag_tesla = mag.Filter(read.mag_tesla);
    }
    sensing::MargSample sample;
    sample.sequence = static_cast<std::uint32_t>(row + 1);
    sample.measured_at = Time{} + std::chrono::seconds(1) + std::chrono::milliseconds(10 * row);
    model.Read(read, sample);
    made.trial.samples.push_back(sample);
    made.trial.q_reference.push_back(read.q_earth_sensor);
    made.trial.known.push_back(1);
    made.part.push_back(plan.part(t_s));
    made.trial.scored.push_back(made.part.back() == ExperimentPart::kNotScored ? 0 : 1);
    if (made.trial.samples.size() <= offset_rows) {
      offset_rad_s += sample.gyro_rad_s / static_cast<float>(offset_rows);
    }
  }
  for (sensing::MargSample& sample : made.trial.samples) {
    sample.gyro_rad_s -= offset_rad_s;
  }
  return made;
}

ExperimentPlan StaticPlan(IronArrival arrival, simulation::Random random, double duration_s) {
  const Eigen::Vector3d towards = HorizontalDirection(random);
  const auto iron = MovingIron::Make(3.75, Eigen::Vector3d::Zero(), 0.05, towards, random);
  ExperimentPlan plan;
  plan.duration_s = kStill_s + duration_s;
  plan.motion = [](double) { return TurnedBy({}, {}, 0.0); };
  plan.world = [iron, arrival](double t_s) {
    switch (arrival) {
      case IronArrival::kNever:
        return simulation::MagneticWorld{};
      case IronArrival::kFromStart:
        return iron.World(1.0);
      case IronArrival::kAfterStart:
        break;
    }
    return iron.World(simulation::SmoothStep(Jet::Variable(t_s), kStill_s, kStill_s + 2.0).value);
  };
  plan.part = WholeMovement(ExperimentPart::kNearIron);
  return plan;
}

ExperimentPlan QuasiStaticPlan(simulation::Random random) {
  constexpr double kIronComes_s = 28.0;
  constexpr double kIronGoes_s = 55.0;
  std::vector<Turn> turns;
  double t_s = kStill_s;
  AppendTurns(turns, t_s, {0, 1, 2}, 1.0);
  t_s = kIronComes_s + 2.0;
  AppendTurns(turns, t_s, {0, 1, 2}, -1.0);
  t_s = kIronGoes_s + 2.0;
  AppendTurns(turns, t_s, {0}, 1.0);
  const Eigen::Vector3d towards = HorizontalDirection(random);
  const auto iron = MovingIron::Make(3.75, Eigen::Vector3d::Zero(), 0.05, towards, random);
  ExperimentPlan plan;
  plan.duration_s = t_s;
  plan.motion = [turns](double t) { return TurnedBy(turns, {}, t); };
  plan.world = [iron](double t) {
    return iron.World(
        simulation::Window(Jet::Variable(t), kIronComes_s, kIronGoes_s + 2.0, 2.0).value);
  };
  plan.part = [turns](double t) {
    constexpr double kSettled_s = 0.2;  // the analog filters have caught up
    for (const Turn& turn : turns) {
      if (t >= turn.from_s && t < turn.to_s + kSettled_s) {
        return ExperimentPart::kNotScored;
      }
    }
    const bool near = t > kIronComes_s + 2.0 && t < kIronGoes_s;
    const bool clean = t > 1.0 && (t < kIronComes_s || t > kIronGoes_s + 2.0);
    return near    ? ExperimentPart::kNearIron
           : clean ? ExperimentPart::kClean
                   : ExperimentPart::kNotScored;
  };
  return plan;
}

ExperimentPlan ElbowPlan(double frequency_hz, double iron_gap_m, simulation::Random random) {
  constexpr int kRepetitions = 20;
  constexpr double kBegin_s = kStill_s + 2.0;
  const double range_rad = RadFromDeg(60.0);
  const simulation::Arm arm;
  // The elbow is on the table at the origin: the upper arm takes no part in it.
  const auto motion = [=](double t_s) {
    return simulation::WristOf(
        {.upper_m = 0.0, .fore_m = arm.fore_m}, {},
        {.heading = kNorth_rad,
         .flexion = {},
         .abduction = {},
         .elbow = range_rad * Swing(t_s, frequency_hz, kBegin_s, kRepetitions),
         .pronation = {}});
  };
  const auto iron = MovingIron::Make(5.0, motion(0.0).p_earth_local_m, iron_gap_m,
                                     Eigen::Vector3d::UnitY(), random);
  ExperimentPlan plan;
  plan.duration_s = kBegin_s + kRepetitions / frequency_hz;
  plan.motion = motion;
  plan.world = [iron, iron_gap_m](double t_s) {
    return iron_gap_m > 0.0
               ? iron.World(
                     simulation::SmoothStep(Jet::Variable(t_s), kStill_s, kStill_s + 1.5).value)
               : simulation::MagneticWorld{};
  };
  plan.part = [iron_gap_m](double t_s) {
    return t_s < kBegin_s     ? ExperimentPart::kNotScored
           : iron_gap_m > 0.0 ? ExperimentPart::kNearIron
                              : ExperimentPart::kClean;
  };
  return plan;
}

ExperimentPlan ArmPlan(bool near_case, simulation::Random random) {
  const Subject subject = Subject::Make(near_case, random);
  const double flexion_hz = random.Uniform(0.3, 0.5);
  const double abduction_hz = random.Uniform(0.3, 0.5);
  const double sway_rad = random.Uniform(0.0, 6.0);
  ExperimentPlan plan;
  plan.duration_s = 60.0;
  plan.offset_time_s = kStill_s;
  plan.motion = [=](double t_s) {
    // Flexion to 80° for half of the time, abduction to 70° for the other half, by turns of 10 s.
    const Jet t = Jet::Variable(t_s);
    const double turn = std::floor(t_s / 10.0);
    const Jet in_turn = simulation::Window(t, 10.0 * turn, 10.0 * turn + 10.0, 1.5);
    const bool flexing = std::fmod(turn, 2.0) < 0.5;
    const Jet lift =
        in_turn * 0.5 *
        (1.0 - simulation::Cos(2.0 * std::numbers::pi * (flexing ? flexion_hz : abduction_hz) *
                               (t - 10.0 * turn)));
    const Jet moving = simulation::SmoothStep(t, kStill_s + 2.5, kStill_s + 4.5);
    return simulation::WristOf(
        {}, subject.Shoulder(t_s),
        {.heading = subject.heading_rad + RadFromDeg(5.0) * Wave(t_s, 0.2, sway_rad),
         .flexion = -kNorth_rad + moving * (RadFromDeg(flexing ? 80.0 : 25.0) * lift),
         .abduction = moving * (RadFromDeg(flexing ? 5.0 : 60.0) * lift),
         .elbow = RadFromDeg(10.0) + RadFromDeg(8.0) * Wave(t_s, 0.37, 1.0),
         .pronation = RadFromDeg(15.0) * Wave(t_s, 0.29, 2.0)});
  };
  plan.world = [subject](double) {
    simulation::MagneticWorld world;
    world.iron = subject.iron;
    return world;
  };
  plan.part = WholeMovement(near_case ? ExperimentPart::kNearIron : ExperimentPart::kClean);
  return plan;
}

ExperimentPlan AssemblyPlan(simulation::Random random) {
  Subject subject = Subject::Make(true, random);
  subject.away_s = {{60.0, 68.0}};
  std::array<double, 8> at{};
  for (double& value : at) {
    value = random.Uniform(0.0, 2.0 * std::numbers::pi);
  }
  const double pace = random.Uniform(0.8, 1.2);
  ExperimentPlan plan;
  plan.duration_s = 90.0;
  plan.offset_time_s = kStill_s;
  plan.motion = [=](double t_s) {
    // The hand over the top of the case: reaching, putting down, turning things over.
    const Jet raised = simulation::SmoothStep(Jet::Variable(t_s), kStill_s + 2.0, kStill_s + 4.0);
    const auto wave = [&](double amplitude_deg, double frequency_hz, std::size_t i) {
      return RadFromDeg(amplitude_deg) * Wave(t_s, pace * frequency_hz, at[i]);
    };
    return simulation::WristOf(
        {}, subject.Shoulder(t_s),
        {.heading = subject.heading_rad + wave(8.0, 0.11, 0),
         .flexion = -kNorth_rad + raised * RadFromDeg(35.0) + wave(12.0, 0.31, 1),
         .abduction = wave(12.0, 0.23, 2) + wave(6.0, 0.61, 3),
         .elbow = RadFromDeg(10.0) + raised * RadFromDeg(35.0) + wave(18.0, 0.41, 4) +
                  wave(6.0, 0.97, 5),
         .pronation = wave(35.0, 0.37, 6) + wave(12.0, 0.83, 7)});
  };
  plan.world = [subject](double) {
    simulation::MagneticWorld world;
    world.iron = subject.iron;
    return world;
  };
  plan.part = WholeMovement(ExperimentPart::kNearIron);
  return plan;
}

}  // namespace limbcast::tool
