#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "common/math/rotation.hpp"
#include "services/fusion/body_positions.hpp"
#include "services/gateway/coil_pulse_driver.hpp"
#include "services/gateway/drivers/simulator/simulator_driver.hpp"

namespace limbcast::test_support {

/// Position against truth of one segment over a run: coils in the source's axes, markers in the
/// earth frame.
struct PositionFigure {
  double rms_m = 0.0;
  double max_m = 0.0;
  double sigma_m = 0.0;       ///< RMS of what the filter says, 3-D
  int count = 0;              ///< scored
  int expected = 0;           ///< samples in the scored time
  double first_s = -1.0;      ///< when there was a position first
  double lagged_rms_m = 0.0;  ///< of what is said of earlier times
  int lagged_count = 0;
};
using PositionFigures = std::map<std::pair<std::uint32_t, body::Segment>, PositionFigure>;

/// Error of a position against the truth of its instant; `off` turns the orientations given.
inline double PositionError_m(const body::SegmentState& state, const body::SegmentTruth& truth,
                              const body::SegmentTruth* source, const Eigen::Quaterniond& off) {
  const Eigen::Vector3d p_m = state.p_earth_sensor_m.cast<double>();
  if (state.position_reference != PositionReference::kSensor) {
    return (p_m - truth.p_earth_sensor_m).norm();
  }
  return (off.conjugate() * p_m - (truth.p_earth_sensor_m - source->p_earth_sensor_m)).norm();
}

inline void AddTo(double& rms, int& count, double value) {
  const double n = count++;
  rms = std::sqrt((n * rms * rms + value * value) / (n + 1.0));
}

/// Simulator, pulse extraction and position tracks without bus and processes; orientations are the
/// truth, `heading_error_rad` off. Scored from `score_from_s` on; the tracks begin to hear at
/// `begin_s`.
inline PositionFigures RunPositions(const gateway::SimulatorConfig& simulator,
                                    const fusion::PositionConfig& config, double seconds,
                                    double score_from_s, double heading_error_rad = 0.0,
                                    double begin_s = 0.0) {
  auto made = gateway::SimulatorDriver::Make(simulator);
  EXPECT_TRUE(made) << made.error().message;
  const auto driver = gateway::WithCoilPulses(std::move(*made));
  std::map<std::uint32_t, std::unique_ptr<fusion::BodyPositions>> bodies;
  for (const roster::RosterEntry& entry : driver->Describe().bodies) {
    fusion::BodyPlan plan{.body_id = entry.body_id, .tracks = {}};
    for (const roster::SensorAssignment& sensor : entry.sensors) {
      plan.tracks.push_back(
          {.sensor_uid = sensor.sensor_uid, .segment = sensor.segment, .filters = {}});
    }
    auto& body = bodies[entry.body_id.value];
    body = std::make_unique<fusion::BodyPositions>(config);
    body->Apply(plan);
  }
  PositionFigures figures;
  std::map<Time, std::map<std::pair<std::uint32_t, body::Segment>, body::SegmentTruth>> truths;
  gateway::Batch batch;
  const Eigen::Quaterniond off = math::ExpSO3({0.0, 0.0, heading_error_rad});
  const auto ticks = static_cast<int>(seconds * simulator.rate_hz);
  for (int tick = 0; tick < ticks; ++tick) {
    EXPECT_TRUE(driver->Next(batch));
    const double t_s = tick / simulator.rate_hz;
    if (t_s < begin_s) {
      continue;
    }
    for (const sensing::MarkerPosition& marker : batch.markers) {
      bodies.at(marker.body_id.value)->OnMarker(marker);
    }
    const body::SegmentTruth* source = nullptr;
    for (std::size_t i = 0; i < batch.marg.size(); ++i) {
      const body::SegmentTruth& truth = batch.truth[i];
      EXPECT_EQ(truth.sensor_uid, batch.marg[i].sensor_uid);
      if (config.coils.source == truth.segment) {
        source = &truth;
      }
      body::SegmentState state;
      state.body_id = truth.body_id;
      state.segment = truth.segment;
      state.sensor_uid = truth.sensor_uid;
      state.verdict = SampleVerdict::kFused;
      state.started = true;
      state.measured_at = truth.measured_at;
      state.q_earth_sensor = off * truth.q_earth_sensor;
      fusion::BodyPositions& body = *bodies.at(truth.body_id.value);
      truths[truth.measured_at][{truth.body_id.value, truth.segment}] = truth;
      body.Update(batch.marg[i], state);
      const body::SegmentState* const lagged = body.Lagged(state);
      const auto& named = config.coils.sensors;
      const auto& marked = config.markers.segments;
      const bool coil = config.coils.source &&
                        std::find(named.begin(), named.end(), truth.segment) != named.end();
      if (!coil && std::find(marked.begin(), marked.end(), truth.segment) == marked.end()) {
        EXPECT_FALSE(state.has_position);
        continue;
      }
      PositionFigure& figure = figures[{truth.body_id.value, truth.segment}];
      if (state.has_position && figure.first_s < 0.0) {
        figure.first_s = t_s;
      }
      if (t_s < score_from_s) {
        continue;
      }
      ++figure.expected;
      if (lagged != nullptr) {
        const auto& then = truths.at(lagged->measured_at);
        const body::SegmentTruth* const its_source =
            config.coils.source ? &then.at({truth.body_id.value, *config.coils.source}) : nullptr;
        AddTo(figure.lagged_rms_m, figure.lagged_count,
              PositionError_m(*lagged, then.at({truth.body_id.value, truth.segment}), its_source,
                              off));
      }
      if (!state.has_position) {
        continue;
      }
      const double error_m = PositionError_m(state, truth, source, off);
      const double n = figure.count;
      AddTo(figure.rms_m, figure.count, error_m);
      figure.sigma_m = std::sqrt((n * figure.sigma_m * figure.sigma_m +
                                  static_cast<double>(state.cov_position_m2.trace())) /
                                 (n + 1.0));
      figure.max_m = std::max(figure.max_m, error_m);
    }
  }
  return figures;
}

/// People who stand for 2 s and then go through the default schedule, with coils and without iron:
/// beside furniture the field changes faster than the filter can follow.
inline gateway::SimulatorConfig CoilPeople(std::uint32_t persons = 1, double spacing_m = 1.5) {
  gateway::SimulatorConfig config;
  config.persons = persons;
  config.spacing_m = spacing_m;
  config.n_pose_s = 2.0;
  config.iron = false;
  config.coils.source = body::Segment::kPelvis;
  return config;
}

inline fusion::PositionConfig CoilAid() {
  fusion::PositionConfig config;
  config.coils.source = body::Segment::kPelvis;
  return config;
}

}  // namespace limbcast::test_support
