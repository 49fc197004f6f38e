#include "tools/limbcast/evaluate/orientation_trial.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include "common/math/rotation.hpp"
#include "common/units/units.hpp"

namespace limbcast::tool {
namespace {

constexpr std::size_t kPlotPoints = 600;

// Normalised error squared; the covariance is of the earth-frame rotation error.
double Nees(const filters::FilterEstimate& estimate, const Eigen::Quaterniond& q_reference) {
  const Eigen::Vector3d error_rad = math::LogSO3(q_reference * estimate.q_earth_sensor.conjugate());
  const Eigen::Matrix3d P = estimate.cov_orientation_rad2 + 1e-12 * Eigen::Matrix3d::Identity();
  return error_rad.dot(P.ldlt().solve(error_rad));
}

ErrorPoint PointOf(const OrientationError& error, double time_s, double trace_rad2) {
  return {.time_s = time_s,
          .total_deg = units::DegFromRad(error.total_rad),
          .heading_deg = units::DegFromRad(error.heading_rad),
          .inclination_deg = units::DegFromRad(error.inclination_rad),
          .sigma_deg = units::DegFromRad(std::sqrt(std::max(trace_rad2, 0.0)))};
}

}  // namespace

TrialGroup GroupOf(const std::string& trial_name) {
  if (trial_name.find("undisturbed") != std::string::npos) {
    return TrialGroup::kUndisturbed;
  }
  return trial_name.find("disturbed") != std::string::npos ? TrialGroup::kDisturbed
                                                           : TrialGroup::kOther;
}

std::vector<OrientationTrial> TrialsOf(const gateway::Recording& recording,
                                       const std::string& name) {
  std::map<SensorUid, OrientationTrial> by_sensor;
  std::size_t marg = 0;
  std::size_t truth = 0;
  for (std::size_t tick = 0; tick < recording.ticks.size(); ++tick) {
    std::map<SensorUid, const body::SegmentTruth*> truth_now;
    for (; truth < recording.ticks[tick].truth_end; ++truth) {
      truth_now[recording.truth[truth].sensor_uid] = &recording.truth[truth];
    }
    const bool moving = recording.movement.empty() || recording.movement[tick] != 0;
    for (; marg < recording.ticks[tick].marg_end; ++marg) {
      const sensing::MargSample& sample = recording.marg[marg];
      OrientationTrial& trial = by_sensor[sample.sensor_uid];
      const auto found = truth_now.find(sample.sensor_uid);
      const bool known = found != truth_now.end() && found->second->sensor_valid;
      trial.samples.push_back(sample);
      trial.q_reference.push_back(known ? found->second->q_earth_sensor
                                        : Eigen::Quaterniond::Identity());
      trial.known.push_back(known ? 1 : 0);
      trial.scored.push_back(known && moving ? 1 : 0);
    }
  }
  std::vector<OrientationTrial> trials;
  for (const gateway::RecordedSensor& sensor : recording.sensors) {
    const auto found = by_sensor.find(sensor.info.sensor_uid);
    if (found == by_sensor.end() ||
        std::find(found->second.scored.begin(), found->second.scored.end(), 1) ==
            found->second.scored.end()) {
      continue;
    }
    found->second.name = by_sensor.size() == 1 ? name : name + "." + sensor.info.label;
    trials.push_back(std::move(found->second));
  }
  return trials;
}

OrientationResult EvaluateTrial(const OrientationTrial& trial, filters::OrientationFilter& filter) {
  OrientationResult result;
  result.trial = trial.name;
  result.group = GroupOf(trial.name);
  result.filter = std::string(filter.name());
  result.q_earth_sensor.reserve(trial.samples.size());
  const std::size_t plot_every = std::max<std::size_t>(trial.samples.size() / kPlotPoints, 1);
  double nees_sum = 0.0;
  std::uint64_t nees_count = 0;
  std::chrono::duration<double> busy{0.0};
  for (std::size_t row = 0; row < trial.samples.size(); ++row) {
    const auto before = std::chrono::steady_clock::now();
    const SampleVerdict verdict = filter.Update(trial.samples[row]);
    busy += std::chrono::steady_clock::now() - before;
    result.verdicts.Add(verdict);
    const filters::FilterEstimate& estimate = filter.estimate();
    result.q_earth_sensor.push_back(math::Canonical(estimate.q_earth_sensor));
    result.disturbed_rows += estimate.magnetic_state == MagneticState::kDisturbed ? 1 : 0;
    const bool scored = trial.scored[row] != 0;
    if (!scored && row % plot_every != 0) {
      continue;
    }
    const OrientationError error = ErrorBetween(estimate.q_earth_sensor, trial.q_reference[row]);
    if (scored) {
      result.errors.Add(error);
    }
    if (scored && estimate.started) {  // before, there is no covariance
      nees_sum += Nees(estimate, trial.q_reference[row]);
      ++nees_count;
    }
    if (row % plot_every == 0) {
      const double time_s =
          ToSeconds(trial.samples[row].measured_at - trial.samples.front().measured_at);
      result.points.push_back(PointOf(error, time_s, estimate.cov_orientation_rad2.trace()));
      result.points.back().scored = scored;
      result.points.back().known = trial.known[row] != 0;
    }
  }
  if (nees_count > 0) {
    result.mean_nees = nees_sum / static_cast<double>(nees_count);
  }
  result.samples_per_s =
      busy.count() > 0.0 ? static_cast<double>(trial.samples.size()) / busy.count() : 0.0;
  return result;
}

}  // namespace limbcast::tool
