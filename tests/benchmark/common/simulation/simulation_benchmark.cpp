#include <benchmark/benchmark.h>

#include "common/simulation/marg_model.hpp"
#include "common/simulation/person_motion.hpp"
#include "common/simulation/sensor_set.hpp"
#include "services/gateway/drivers/simulator/simulator_driver.hpp"

namespace limbcast {
namespace {

void PersonPoseAtAnInstant(benchmark::State& state) {
  const auto person = *simulation::PersonMotion::Make(*simulation::MakePersonShape(1.75), {});
  double t_s = 0.0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(person.At(t_s));
    t_s += 0.01;
  }
}
BENCHMARK(PersonPoseAtAnInstant);

void OneSensorReading(benchmark::State& state) {
  const auto person = *simulation::PersonMotion::Make(*simulation::MakePersonShape(1.75), {});
  const auto mounting = simulation::MakeMounting(body::Segment::kLeftHand, person.shape(),
                                                 simulation::MountingStyle::kArbitrary, 1);
  simulation::MagneticWorld world;
  world.iron = simulation::MakeIronZones(person, 60.0, 1);
  simulation::MargModel model(simulation::MakeMargErrors(simulation::NoisePreset::kDefault), 100.0,
                              simulation::Random(1));
  const auto segment = person.At(10.0).segments[body::Index(body::Segment::kLeftHand)];
  sensing::MargSample sample;
  for (auto _ : state) {
    model.Read(simulation::MakeIdealMarg(segment, mounting, world), sample);
    benchmark::DoNotOptimize(sample);
  }
}
BENCHMARK(OneSensorReading);

// One tick of the driver: 17 sensors and their truth for each person. Target: 100 µs a person.
void DriverTick(benchmark::State& state) {
  gateway::SimulatorConfig config;
  config.persons = static_cast<std::uint32_t>(state.range(0));
  auto driver = *gateway::SimulatorDriver::Make(config);
  gateway::Batch batch;
  for (auto _ : state) {
    benchmark::DoNotOptimize(driver->Next(batch));
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(DriverTick)->Arg(1)->Arg(8);

}  // namespace
}  // namespace limbcast
