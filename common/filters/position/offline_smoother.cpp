#include "common/filters/position/offline_smoother.hpp"

#include <algorithm>
#include <optional>

#include "common/base/expects.hpp"

namespace limbcast::filters {
namespace {

struct Begin {
  Time at{};
  OpticalInertialState state;
};

// Feeds both streams in the order of time; stops when `each` returns false.
template <typename Each>
void Feed(OpticalInertialFilter& filter, std::span<const sensing::MargSample> samples,
          std::span<const sensing::MarkerPosition> markers, const Each& each) {
  std::size_t next = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    // Markers up to half way to the next sample belong to this one.
    const Time until =
        i + 1 < samples.size()
            ? samples[i].measured_at + (samples[i + 1].measured_at - samples[i].measured_at) / 2
            : samples[i].measured_at;
    for (; next < markers.size() && markers[next].measured_at <= until; ++next) {
      (void)filter.AddMarker(markers[next]);
    }
    if (!each(samples[i])) {
      return;
    }
  }
}

template <typename T>
std::span<const T> From(std::span<const T> all, Time from) {
  const auto first = std::lower_bound(all.begin(), all.end(), from,
                                      [](const T& s, Time t) { return s.measured_at < t; });
  return all.subspan(static_cast<std::size_t>(first - all.begin()));
}

std::size_t EpochsOf(std::span<const sensing::MargSample> samples, double block_s) {
  if (samples.empty()) {
    return 0;
  }
  const double length_s = ToSeconds(samples.back().measured_at - samples.front().measured_at);
  return std::min(samples.size(), static_cast<std::size_t>(length_s / block_s) + 1);
}

struct SeenAtRest {
  Time at{};  ///< of the first
  Eigen::Vector3d p_earth_marker_m = Eigen::Vector3d::Zero();
};

// Mean over half a second of the marker from when it was first seen in the rest [from, to]; nothing
// when it was not.
std::optional<SeenAtRest> MarkerAtRest(std::span<const sensing::MarkerPosition> markers, Time from,
                                       Time to) {
  SeenAtRest seen;
  int n = 0;
  for (const auto& marker : markers) {
    const bool counts = marker.measured_at >= from && marker.measured_at <= to && marker.visible &&
                        marker.p_earth_marker_m.allFinite();
    if (!counts || (n > 0 && marker.measured_at > seen.at + DurationFromSeconds(0.5))) {
      continue;
    }
    if (n++ == 0) {
      seen.at = marker.measured_at;
    }
    seen.p_earth_marker_m += marker.p_earth_marker_m;
  }
  if (n == 0) {
    return std::nullopt;
  }
  seen.p_earth_marker_m /= n;
  return seen;
}

// Where the filter found its attitude, or the rest before it.
std::optional<Begin> FindBegin(const OpticalInertialConfig& config,
                               std::span<const sensing::MargSample> samples,
                               std::span<const sensing::MarkerPosition> markers, bool& at_rest) {
  OpticalInertialFilter filter(config);
  std::optional<Begin> begin;
  Feed(filter, samples, markers, [&](const sensing::MargSample& sample) {
    if (filter.AddInertial(sample).restarted) {
      begin = Begin{filter.at(), filter.state()};
    }
    return !begin;
  });
  at_rest = false;
  if (!begin || !filter.start()->had_rest) {
    return begin;
  }
  const OpticalStartResult& start = *filter.start();
  const auto seen = MarkerAtRest(markers, start.rest_begun_at, start.rest_ended_at);
  if (!seen) {
    return begin;
  }
  at_rest = true;
  begin->at = seen->at;
  begin->state.navigation.q_earth_sensor = start.q_earth_sensor_at_rest;
  begin->state.navigation.v_earth_sensor_m_s.setZero();
  begin->state.navigation.p_earth_sensor_m =
      seen->p_earth_marker_m - start.q_earth_sensor_at_rest * begin->state.p_sensor_marker_m;
  return begin;
}

}  // namespace

OfflineResult SmoothOffline(const OpticalInertialConfig& config,
                            std::span<const sensing::MargSample> samples,
                            std::span<const sensing::MarkerPosition> markers, int passes) {
  Expects(passes >= 1, "a pass");
  OfflineResult result;
  std::optional<Begin> begin = FindBegin(config, samples, markers, result.began_at_rest);
  if (!begin) {
    return result;
  }
  for (int pass = 0; pass < passes; ++pass) {
    const auto rest = From(samples, begin->at);
    OpticalInertialFilter filter(config);
    OpticalHistory history;
    history.Reserve(EpochsOf(rest, config.block_s));
    filter.Start(begin->at, begin->state);
    Feed(filter, rest, From(markers, begin->at), [&](const sensing::MargSample& sample) {
      if (filter.AddInertial(sample).epoch_closed) {
        history.Push(filter.epoch());
      }
      return true;
    });
    if (history.forward().empty()) {
      return result;
    }
    result.start = history.SmoothedStart();
    *begin = {history.forward().front().at, result.start};
    if (pass + 1 == passes) {
      result.estimates = history.Smooth();
      result.markers = filter.marker_counters();
      result.inertial = filter.inertial_counters();
    }
  }
  return result;
}

}  // namespace limbcast::filters
