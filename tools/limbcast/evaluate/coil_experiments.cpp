#include "tools/limbcast/evaluate/coil_experiments.hpp"

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "common/base/expects.hpp"
#include "common/body/segment.hpp"
#include "common/simulation/person_motion.hpp"
#include "common/simulation/random.hpp"
#include "common/simulation/smooth_step.hpp"

namespace limbcast::tool {
namespace {

using simulation::GestureKind;
using simulation::Jet;
using simulation::Phase;
using simulation::PhaseKind;
using simulation::RigidMotion;

constexpr double kStill_s = 3.0;

double Rad(double deg) { return deg * std::numbers::pi / 180.0; }

Jet Wave(const Jet& t, double frequency_hz, double at_rad) {
  return simulation::Sin(2.0 * std::numbers::pi * frequency_hz * t + at_rad);
}

// From rest at kStill_s on.
Jet Moving(const Jet& t) { return simulation::SmoothStep(t, kStill_s, kStill_s + 2.0); }

RigidMotion BenchSensor(double t_s, const std::vector<double>& at_rad) {
  const Jet t = Jet::Variable(t_s);
  const Jet on = Moving(t);
  // 10 to 80 cm, slowly; from 30 cm at rest.
  const Jet range = 0.3 + on * (0.15 + 0.349 * Wave(t, 0.05, at_rad[0]));
  const Jet azimuth = Rad(40.0) + on * (Rad(60.0) * Wave(t, 0.06, at_rad[1]));
  const Jet elevation = Rad(50.0) + on * (Rad(20.0) * Wave(t, 0.09, at_rad[2]));
  const Jet flat = range * simulation::Cos(elevation);
  RigidMotion sensor =
      simulation::MovingPoint({flat * simulation::Cos(azimuth), flat * simulation::Sin(azimuth),
                               1.0 + range * simulation::Sin(elevation)});
  simulation::RotateAbout(sensor, 2, on * (Rad(80.0) * Wave(t, 0.11, at_rad[3])));
  simulation::RotateAbout(sensor, 1, on * (Rad(60.0) * Wave(t, 0.13, at_rad[4])));
  simulation::RotateAbout(sensor, 0, on * (Rad(60.0) * Wave(t, 0.17, at_rad[5])));
  return sensor;
}

RigidMotion BenchEmitter() {
  RigidMotion emitter;
  emitter.p_earth_local_m = {0.0, 0.0, 1.0};
  return emitter;
}

// A pelvis that follows by a fifth, and a back of two joints with a sensor 45 cm above the source.
std::pair<RigidMotion, RigidMotion> LateroFlexion(double t_s, double at_rad) {
  const Jet t = Jet::Variable(t_s);
  const Jet bend = Moving(t) * (Rad(20.0) * Wave(t, 0.2, at_rad));
  RigidMotion pelvis = simulation::MovingPoint({0.0, 0.02 * bend, 1.0});
  simulation::RotateAbout(pelvis, 0, 0.2 * bend);
  RigidMotion back = simulation::AtPoint(pelvis, {0.06, 0.0, 0.12});
  simulation::RotateAbout(back, 0, bend);
  back = simulation::AtPoint(back, {0.0, 0.0, 0.15});
  simulation::RotateAbout(back, 0, 0.5 * bend);
  return {simulation::AtPoint(pelvis, {-0.1, 0.0, 0.0}),
          simulation::AtPoint(back, {-0.1, -0.05, 0.18})};
}

struct Body {
  std::shared_ptr<const simulation::PersonMotion> person;

  [[nodiscard]] simulation::MotionFunction At(body::Segment segment,
                                              const Eigen::Vector3d& p_segment_m) const {
    return [person = person, segment, p_segment_m](double t_s) {
      return simulation::AtPoint(person->At(t_s).segments[body::Index(segment)], p_segment_m);
    };
  }
};

Body MakeBody(std::vector<Phase> phases) {
  const auto shape = simulation::MakePersonShape(1.78);
  Expects(shape.ok(), "the average person");
  simulation::PersonMotionConfig config;
  const std::size_t last = phases.size() - 1;
  config.schedule = {.phases = std::move(phases), .repeat_from = last};
  auto person = simulation::PersonMotion::Make(*shape, config);
  Expects(person.ok(), "the schedule of an experiment");
  return {std::make_shared<const simulation::PersonMotion>(std::move(*person))};
}

Body Gesturing(GestureKind kind, double gesture_s) {
  Phase phase{.kind = PhaseKind::kStand, .duration_s = 60.0};
  for (double start_s = kStill_s; start_s + gesture_s < 59.0; start_s += gesture_s + 1.0) {
    phase.gestures.push_back({.kind = kind,
                              .side = simulation::Side::kRight,
                              .start_s = start_s,
                              .duration_s = gesture_s});
  }
  return MakeBody({phase});
}

Body Walking() {
  const Phase still{.kind = PhaseKind::kStand, .duration_s = kStill_s};
  Phase walk{.kind = PhaseKind::kWalk, .path = {{.length_m = 60.0}}, .speed_m_s = 1.2};
  return MakeBody({still, walk, {.kind = PhaseKind::kStand, .duration_s = 60.0}});
}

}  // namespace

std::vector<CoilExperiment> MakeCoilExperiments(std::uint64_t seed) {
  simulation::Random random(seed, "coil experiments");
  std::vector<double> at_rad(8);
  for (double& at : at_rad) {
    at = random.Uniform(0.0, 2.0 * std::numbers::pi);
  }
  const double latero_at_rad = random.Uniform(0.0, 2.0 * std::numbers::pi);

  // Source: on the skin of the lower back, where the sensor on the first thoracic vertebra is 45 cm
  // above it, 6 cm forward and 5 cm to the right, as printed; 10 cm higher for the arm, so that its
  // distance is between 38 and 50 cm, as printed, which from below it would not be on an average
  // person. Sensors: first thoracic vertebra; outside of the arm; above the knee.
  const Eigen::Vector3d p_back_coils_m(-0.12, 0.0, 0.0);
  const Eigen::Vector3d p_arm_coils_m(-0.12, 0.0, 0.1);
  const Eigen::Vector3d p_t8_sensor_m(-0.08, -0.05, 0.22);
  const Eigen::Vector3d p_arm_sensor_m(-0.04, -0.02, -0.06);
  const Eigen::Vector3d p_leg_sensor_m(0.04, -0.06, -0.34);
  constexpr auto kT8 = body::Segment::kT8;
  constexpr auto kArm = body::Segment::kRightUpperArm;
  constexpr auto kLeg = body::Segment::kRightUpperLeg;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();

  std::vector<CoilExperiment> experiments;
  experiments.push_back({"bench", [at_rad](double t_s) { return BenchSensor(t_s, at_rad); },
                         [](double) { return BenchEmitter(); }, false, up, 60.0, 0.1e-6, 7.6, 5.9,
                         5.2, 3.0});
  const auto add = [&](const char* name, const Body& person, body::Segment segment,
                       const Eigen::Vector3d& place_m, const Eigen::Vector3d& half_space,
                       std::array<double, 4> published) {
    const bool is_walk = std::string(name).find("walking") != std::string::npos;
    experiments.push_back(
        {name, person.At(segment, place_m),
         person.At(body::Segment::kL5, segment == kArm ? p_arm_coils_m : p_back_coils_m), true,
         half_space, 45.0, is_walk ? 0.3e-6 : 0.1e-6, published[0], published[1], published[2],
         published[3]});
  };
  const Body walking = Walking();
  add("back flexion", Gesturing(GestureKind::kBow, 5.0), kT8, p_t8_sensor_m, up,
      {5.9, 4.9, 4.8, 2.4});
  experiments.push_back(
      {"back latero-flexion",
       [latero_at_rad](double t_s) { return LateroFlexion(t_s, latero_at_rad).second; },
       [latero_at_rad](double t_s) { return LateroFlexion(t_s, latero_at_rad).first; }, true, up,
       45.0, 0.1e-6, 6.3, 5.2, 5.0, 2.6});
  add("back rotation", Gesturing(GestureKind::kTwist, 5.0), kT8, p_t8_sensor_m, up,
      {5.9, 5.1, 4.9, 2.6});
  add("back walking", walking, kT8, p_t8_sensor_m, up, {8.6, 6.8, 5.6, 3.0});
  add("arm flexion", Gesturing(GestureKind::kRaiseFront, 4.0), kArm, p_arm_sensor_m, up,
      {7.8, 6.6, 5.1, 2.4});
  add("arm abduction", Gesturing(GestureKind::kRaiseSide, 4.0), kArm, p_arm_sensor_m, up,
      {7.2, 6.2, 5.0, 2.3});
  add("arm walking", walking, kArm, p_arm_sensor_m, up, {11.7, 7.4, 7.9, 3.1});
  add("leg walking", walking, kLeg, p_leg_sensor_m, -up, {15.0, 8.7, 8.6, 3.2});
  return experiments;
}

}  // namespace limbcast::tool
