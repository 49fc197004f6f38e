#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <numbers>
#include <vector>

#include "common/body/default_body.hpp"
#include "common/body/forward_kinematics.hpp"
#include "common/body/functional_alignment.hpp"
#include "common/body/motion_record.hpp"
#include "common/math/rotation.hpp"
#include "common/simulation/person_motion.hpp"
#include "common/simulation/random.hpp"
#include "common/simulation/sensor_set.hpp"

namespace limbcast::test_support {

/// A simulated person who stands 3 s in the N-pose and then walks straight on, with perfect sensors
/// that are turned arbitrarily on the segments and each have a heading of their own.
class WalkingPerson {
 public:
  explicit WalkingPerson(std::uint64_t seed = 20240517, double facing_rad = 0.0,
                         double turn_rad = 0.0) {
    simulation::Phase n_pose;
    n_pose.kind = simulation::PhaseKind::kNPose;
    n_pose.duration_s = 3.0;
    simulation::Phase walk;
    walk.kind = simulation::PhaseKind::kWalk;
    walk.path = {{.length_m = 15.0, .turn_rad = 0.0},
                 {.length_m = 5.0, .turn_rad = turn_rad},
                 {.length_m = 15.0, .turn_rad = 0.0}};
    simulation::Phase stand;
    stand.duration_s = 3600.0;
    motion_ = std::make_unique<simulation::PersonMotion>(*simulation::PersonMotion::Make(
        *simulation::MakePersonShape(1.75),
        {.schedule = {.phases = {n_pose, walk, stand}, .repeat_from = 2},
         .start = {.heading_rad = facing_rad}}));
    simulation::Random random(seed);
    for (std::size_t i = 0; i < body::kSegmentCount; ++i) {
      mounting_[i] = simulation::MakeMounting(static_cast<body::Segment>(i), motion_->shape(),
                                              simulation::MountingStyle::kArbitrary, seed);
      sensor_heading_rad_[i] = random.Uniform(-std::numbers::pi, std::numbers::pi);
    }
  }

  /// What the sensor of a segment says at a time: orientation and free acceleration in its own
  /// earth frame.
  struct Reading {
    Eigen::Quaterniond q_earth_sensor;
    Eigen::Vector3d accel_in_earth_m_s2;
  };
  [[nodiscard]] Reading Read(body::Segment segment, double t_s) const {
    const std::size_t i = body::Index(segment);
    const simulation::IdealMarg ideal =
        simulation::MakeIdealMarg(motion_->At(t_s).segments[i], mounting_[i], {});
    const Eigen::Quaterniond turn = math::ExpSO3({0.0, 0.0, sensor_heading_rad_[i]});
    const Eigen::Vector3d gravity_m_s2(0.0, 0.0, simulation::kGravity_m_s2);
    return {.q_earth_sensor = turn * ideal.q_earth_sensor,
            .accel_in_earth_m_s2 = turn * (ideal.q_earth_sensor * ideal.accel_m_s2 - gravity_m_s2)};
  }

  [[nodiscard]] body::MotionRecord Record(const std::vector<body::Segment>& segments, double from_s,
                                          double to_s) const {
    body::MotionRecord record;
    for (const body::Segment segment : segments) {
      body::SegmentRecord one;
      one.segment = segment;
      for (double t_s = from_s; t_s < to_s; t_s += 1.0 / record.rate_hz) {
        const Reading reading = Read(segment, t_s);
        one.q_earth_sensor.push_back(reading.q_earth_sensor);
        one.accel_in_earth_m_s2.push_back(reading.accel_in_earth_m_s2);
      }
      record.segments.push_back(one);
    }
    return record;
  }

  [[nodiscard]] body::StandingPose Standing(const std::vector<body::Segment>& segments) const {
    body::StandingPose pose;
    for (const body::Segment segment : segments) {
      pose.known[body::Index(segment)] = true;
      pose.q_earth_sensor[body::Index(segment)] = Read(segment, 1.0).q_earth_sensor;
    }
    return pose;
  }

  /// What the alignment should be: q_sensor_segment, and the correction that turns the sensor's
  /// heading to that of a body which faces `facing_rad` in the stance.
  [[nodiscard]] Eigen::Quaterniond q_sensor_segment(body::Segment segment) const {
    return mounting_[body::Index(segment)].q_segment_sensor.conjugate();
  }
  [[nodiscard]] double sensor_heading_rad(body::Segment segment) const {
    return sensor_heading_rad_[body::Index(segment)];
  }
  [[nodiscard]] Eigen::Quaterniond Truth(body::Segment segment, double t_s) const {
    return math::QuaternionFromMatrix(
        motion_->At(t_s).segments[body::Index(segment)].R_earth_local);
  }

  static std::vector<body::Segment> Sixteen() {
    const auto segments = body::SixteenSegments();
    return {segments.begin(), segments.end()};
  }

 private:
  std::unique_ptr<simulation::PersonMotion> motion_;
  body::PerSegment<simulation::SensorMounting> mounting_;
  body::PerSegment<double> sensor_heading_rad_{};
};

}  // namespace limbcast::test_support
