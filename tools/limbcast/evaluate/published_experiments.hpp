#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/simulation/magnetic_world.hpp"
#include "common/simulation/marg_model.hpp"
#include "common/simulation/random.hpp"
#include "common/simulation/rigid_motion.hpp"
#include "tools/limbcast/evaluate/orientation_trial.hpp"

namespace limbcast::tool {

/// Which part of an experiment an instant belongs to.
enum class ExperimentPart : std::uint8_t { kNotScored, kClean, kNearIron };

/// One of the experiments of D. Roetenberg, "Inertial and magnetic sensing of human motion" (2006),
/// chapters 2 and 3, as functions of time.
struct ExperimentPlan {
  double duration_s = 0.0;
  std::function<simulation::RigidMotion(double t_s)> motion;
  std::function<simulation::MagneticWorld(double t_s)> world;
  std::function<ExperimentPart(double t_s)> part;
  /// The gyro's offset is the mean over this long at the begin and is taken away, as chapter 3
  /// does; 0 = not.
  double offset_time_s = 0.0;
};

/// What the sensor module recorded of it.
struct SimulatedTrial {
  OrientationTrial trial;
  std::vector<ExperimentPart> part;  ///< of each sample
};

/// The sensor module of the thesis (MT9-A: 100 Hz; gyros behind 50 Hz, accelerometers and
/// magnetometers behind 10 Hz second-order filters, section 2.3). Noise is not printed there: gyro
/// offsets so that integrating them drifts by the 10–25° in a minute of figure 2.7, the rest what
/// such parts have (Murata ENC-03J, Analog Devices ADXL202E, Philips KMZ51).
[[nodiscard]] simulation::MargErrors ThesisSensorErrors();

/// Plays `plan` with a sensor of ThesisSensorErrors drawn from `random`.
[[nodiscard]] SimulatedTrial Simulate(const std::string& name, const ExperimentPlan& plan,
                                      const simulation::Random& random);

/// When the iron of an experiment is there.
enum class IronArrival : std::uint8_t { kNever, kFromStart, kAfterStart };

/// Section 2.3, first: 3.75 kg of iron 5 cm from the module, which lies still for ten minutes.
[[nodiscard]] ExperimentPlan StaticPlan(IronArrival iron, simulation::Random random,
                                        double duration_s = 600.0);

/// Second: quarter turns there and back about x, y and z with rests between; after that the iron
/// stands at 5 cm from 30 to 55 s, for the same in opposite directions; at last x once more.
/// Scored at rest.
[[nodiscard]] ExperimentPlan QuasiStaticPlan(simulation::Random random);

/// Third: the elbow on a table, the fore arm moved twenty times from the table and back, with 5 kg
/// of iron in front of the hand. The range is not printed; 60° here.
///
/// @param iron_gap_m  from the module to the iron with the arm on the table; 0 = no iron.
[[nodiscard]] ExperimentPlan ElbowPlan(double frequency_hz, double iron_gap_m,
                                       simulation::Random random);

/// Section 3.2.2: ab/adduction and flexion/extension of the arm for a minute, before a steel case
/// of 70 × 35 × 90 cm or in free space.
[[nodiscard]] ExperimentPlan ArmPlan(bool near_case, simulation::Random random);

/// Ibid.: packing small things on top of the case for 90 s, with a step back for 5 s in between.
[[nodiscard]] ExperimentPlan AssemblyPlan(simulation::Random random);

}  // namespace limbcast::tool
