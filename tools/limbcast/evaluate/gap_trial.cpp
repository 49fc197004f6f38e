#include "tools/limbcast/evaluate/gap_trial.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <span>

#include "common/filters/position/fixed_lag_position.hpp"
#include "common/filters/position/offline_smoother.hpp"
#include "common/filters/position/polynomial_fill.hpp"

namespace limbcast::tool {
namespace {

using filters::PositionEstimate;
using Estimates = std::vector<PositionEstimate>;

constexpr double kSettle_s = 5.0;
constexpr double kBetweenGaps_s = 3.0;
constexpr double kKnownShare = 0.9;

std::size_t Rows(double seconds, double rate_hz) {
  return static_cast<std::size_t>(std::llround(seconds * rate_hz));
}

std::size_t FirstScoredRow(const GapTrial& trial) {
  const auto moving = std::find(trial.movement.begin(), trial.movement.end(), 1);
  return static_cast<std::size_t>(moving - trial.movement.begin()) + Rows(kSettle_s, trial.rate_hz);
}

std::size_t RowOf(const GapTrial& trial, Time at) {
  const auto row =
      std::lower_bound(trial.samples.begin(), trial.samples.end(), at,
                       [](const sensing::MargSample& s, Time t) { return s.measured_at < t; });
  return static_cast<std::size_t>(row - trial.samples.begin());
}

struct Live {
  Estimates forward;
  Estimates lagged;
};

Live RunLive(const filters::OpticalInertialConfig& config, const GapTrial& trial,
             std::span<const sensing::MarkerPosition> markers) {
  filters::OpticalInertialFilter filter(config);
  filters::FixedLagPosition lag(config);
  Live live;
  for (std::size_t row = 0; row < trial.samples.size(); ++row) {
    (void)filter.AddMarker(markers[row]);
    if (!filter.AddInertial(trial.samples[row]).epoch_closed) {
      continue;
    }
    live.forward.push_back(ForwardEstimate(filter.epoch()));
    lag.Push(filter.epoch());
    if (lag.has_estimate()) {
      live.lagged.push_back(lag.estimate());
    }
  }
  return live;
}

FillFigure ScoreGaps(const GapTrial& trial, std::span<const Gap> gaps, const Estimates& estimates) {
  FillFigure figure;
  std::vector<double> largest_m(gaps.size(), 0.0);
  std::vector<double> largest_z_m(gaps.size(), 0.0);
  std::size_t g = 0;
  std::size_t n = 0;
  for (const PositionEstimate& estimate : estimates) {
    const std::size_t row = RowOf(trial, estimate.at);
    while (g < gaps.size() && row >= gaps[g].end) {
      ++g;
    }
    if (g == gaps.size()) {
      break;
    }
    if (row < gaps[g].begin || !trial.markers[row].visible) {
      continue;
    }
    const Eigen::Vector3d e = estimate.p_earth_marker_m - trial.markers[row].p_earth_marker_m;
    largest_m[g] = std::max(largest_m[g], e.norm());
    largest_z_m[g] = std::max(largest_z_m[g], std::abs(e.z()));
    figure.mean_nees += e.dot(estimate.cov_position_m2.ldlt().solve(e));
    ++n;
  }
  figure.mean_nees /= static_cast<double>(std::max<std::size_t>(n, 1));
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    figure.mean_max_m += largest_m[i] / static_cast<double>(gaps.size());
    figure.mean_max_z_m += largest_z_m[i] / static_cast<double>(gaps.size());
    figure.worst_max_m = std::max(figure.worst_max_m, largest_m[i]);
  }
  return figure;
}

FillFigure ScoreRows(const GapTrial& trial, std::size_t from, const Estimates& estimates) {
  FillFigure figure;
  double sum = 0.0;
  std::size_t n = 0;
  for (const PositionEstimate& estimate : estimates) {
    const std::size_t row = RowOf(trial, estimate.at);
    if (row < from || trial.movement[row] == 0 || !trial.markers[row].visible) {
      continue;
    }
    const double error_m = (estimate.p_earth_marker_m - trial.markers[row].p_earth_marker_m).norm();
    sum += error_m * error_m;
    figure.max_m = std::max(figure.max_m, error_m);
    ++n;
  }
  figure.rms_m = std::sqrt(sum / static_cast<double>(std::max<std::size_t>(n, 1)));
  return figure;
}

// The spline as estimates, so that it is scored like the others.
Estimates Spline(const GapTrial& trial, std::span<const Gap> gaps,
                 std::span<const sensing::MarkerPosition> markers) {
  std::vector<filters::SeenMarker> seen;
  for (const sensing::MarkerPosition& marker : markers) {
    if (marker.visible) {
      seen.push_back({marker.measured_at, marker.p_earth_marker_m});
    }
  }
  Estimates estimates;
  for (const Gap& gap : gaps) {
    const auto from = filters::FitGapEnd(seen, markers[gap.begin - 1].measured_at, true);
    const auto to = filters::FitGapEnd(seen, markers[gap.end].measured_at, false);
    for (std::size_t row = gap.begin; row < gap.end; ++row) {
      PositionEstimate estimate;
      estimate.at = trial.samples[row].measured_at;
      estimate.p_earth_marker_m = HermiteFill(*from, *to, estimate.at);
      estimate.cov_position_m2.setIdentity();
      estimates.push_back(estimate);
    }
  }
  return estimates;
}

FillFigure& Figure(GapResult& result, GapFill fill) {
  return result.fills[static_cast<std::size_t>(fill)];
}

}  // namespace

std::optional<GapTrial> GapTrialOf(const gateway::Recording& recording, const std::string& name) {
  for (const gateway::RecordedSensor& sensor : recording.sensors) {
    const SensorUid uid = sensor.info.sensor_uid;
    GapTrial trial;
    trial.name = name;
    trial.rate_hz = recording.rate_hz;
    std::size_t t = 0;
    std::size_t tick = 0;
    bool any = false;
    for (std::size_t i = 0; i < recording.marg.size(); ++i) {
      while (tick < recording.ticks.size() && recording.ticks[tick].marg_end <= i) {
        ++tick;
      }
      const sensing::MargSample& sample = recording.marg[i];
      if (sample.sensor_uid != uid) {
        continue;
      }
      while (t < recording.truth.size() && (recording.truth[t].sensor_uid != uid ||
                                            recording.truth[t].measured_at < sample.measured_at)) {
        ++t;
      }
      sensing::MarkerPosition marker;
      marker.measured_at = sample.measured_at;
      if (t < recording.truth.size() && recording.truth[t].measured_at == sample.measured_at &&
          recording.truth[t].segment_valid) {
        marker.visible = any = true;
        marker.p_earth_marker_m = recording.truth[t].p_earth_segment_m;
      }
      trial.samples.push_back(sample);
      trial.markers.push_back(marker);
      trial.movement.push_back(tick < recording.movement.size() ? recording.movement[tick] : 1);
    }
    if (any) {
      return trial;
    }
  }
  return std::nullopt;
}

std::vector<Gap> PlaceGaps(const GapTrial& trial, double gap_s) {
  const std::size_t length = std::max<std::size_t>(Rows(gap_s, trial.rate_hz), 1);
  const std::size_t period = length + Rows(kBetweenGaps_s, trial.rate_hz);
  std::vector<Gap> gaps;
  for (std::size_t begin = std::max<std::size_t>(FirstScoredRow(trial), 1);
       begin + length < trial.samples.size(); begin += period) {
    const std::size_t end = begin + length;
    bool moving = true;
    std::size_t known = 0;
    for (std::size_t row = begin - 1; row <= end; ++row) {
      moving = moving && trial.movement[row] != 0;
      known += row >= begin && row < end && trial.markers[row].visible ? std::size_t{1} : 0;
    }
    if (moving && trial.markers[begin - 1].visible && trial.markers[end].visible &&
        static_cast<double>(known) >= kKnownShare * static_cast<double>(length)) {
      gaps.push_back({begin, end});
    }
  }
  return gaps;
}

GapResult EvaluateGaps(const filters::OpticalInertialConfig& config, const GapTrial& trial,
                       double gap_s) {
  const std::vector<Gap> gaps = PlaceGaps(trial, gap_s);
  std::vector<sensing::MarkerPosition> markers = trial.markers;
  for (const Gap& gap : gaps) {
    for (std::size_t row = gap.begin; row < gap.end; ++row) {
      markers[row].visible = false;
    }
  }
  GapResult result;
  result.trial = trial.name;
  result.gap_s = gap_s;
  result.gaps = gaps.size();
  const Live live = RunLive(config, trial, markers);
  Figure(result, GapFill::kForward) = ScoreGaps(trial, gaps, live.forward);
  Figure(result, GapFill::kFixedLag) = ScoreGaps(trial, gaps, live.lagged);
  Figure(result, GapFill::kSmoothed) =
      ScoreGaps(trial, gaps, SmoothOffline(config, trial.samples, markers).estimates);
  Figure(result, GapFill::kSpline) = ScoreGaps(trial, gaps, Spline(trial, gaps, markers));
  return result;
}

GapResult EvaluateRatio(const filters::OpticalInertialConfig& config, const GapTrial& trial,
                        int ratio) {
  const std::size_t from = FirstScoredRow(trial);
  std::vector<sensing::MarkerPosition> markers = trial.markers;
  for (std::size_t row = from; row < markers.size(); ++row) {
    markers[row].visible =
        markers[row].visible && (row - from) % static_cast<std::size_t>(ratio) == 0;
  }
  GapResult result;
  result.trial = trial.name;
  result.ratio = ratio;
  const Live live = RunLive(config, trial, markers);
  Figure(result, GapFill::kForward) = ScoreRows(trial, from, live.forward);
  Figure(result, GapFill::kFixedLag) = ScoreRows(trial, from, live.lagged);
  Figure(result, GapFill::kSmoothed) =
      ScoreRows(trial, from, SmoothOffline(config, trial.samples, markers).estimates);
  return result;
}

}  // namespace limbcast::tool
