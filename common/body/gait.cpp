#include "common/body/gait.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace limbcast::body {
namespace {

constexpr double kMinStride_s = 0.7;
constexpr double kMaxStride_s = 2.2;
/// A leg that walks turns by 1.5 rad/s and more (rms); one that stands shifts its weight.
constexpr double kMinLegRate_rad_s = 0.6;
constexpr double kMinTrunkAccel_m_s2 = 0.5;
/// Longer than a stride, so that the stance of one leg does not end a walk.
constexpr double kActivityWindow_s = 1.6;

/// Unbiased autocorrelation of `x` about its mean at lags from 0 to `last`, 1 at lag 0.
std::vector<double> Autocorrelation(std::vector<double> x, std::size_t last) {
  double mean = 0.0;
  for (const double value : x) {
    mean += value / static_cast<double>(x.size());
  }
  for (double& value : x) {
    value -= mean;
  }
  std::vector<double> out(last + 1, 0.0);
  for (std::size_t lag = 0; lag <= last; ++lag) {
    for (std::size_t i = 0; i + lag < x.size(); ++i) {
      out[lag] += x[i] * x[i + lag];
    }
    out[lag] /= static_cast<double>(x.size() - lag);
  }
  const double power = out[0];
  for (double& value : out) {
    value = power > 0.0 ? value / power : 0.0;
  }
  return out;
}

/// Least rms of all stretches of `width` values.
double WeakestRms(const std::vector<double>& x, std::size_t width) {
  double sum = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < x.size(); ++i) {
    sum += x[i] * x[i] - (i >= width ? x[i - width] * x[i - width] : 0.0);
    if (i + 1 >= width) {
      least = std::min(least, sum);
    }
  }
  return std::isinf(least) ? 0.0 : std::sqrt(std::max(0.0, least) / static_cast<double>(width));
}

/// The first maximum in [first, last] that is about as high as the highest; 0 = none.
std::size_t FirstPeak(const std::vector<double>& values, std::size_t first, std::size_t last) {
  constexpr double kAsHigh = 0.85;
  double highest = 0.0;
  for (std::size_t i = first; i < last; ++i) {
    highest = std::max(highest, values[i]);
  }
  for (std::size_t i = first; i < last; ++i) {
    if (values[i] >= kAsHigh * highest && values[i] >= values[i - 1] &&
        values[i] >= values[i + 1]) {
      return i;
    }
  }
  return 0;
}

struct Signals {
  std::vector<std::vector<double>> all;
  double least = 0.0;           // rms that counts as walking
  double periods_a_stride = 1;  // of these signals
};

Signals SignalsOf(const std::vector<SmoothMotion>& motions) {
  Signals legs{.all = {}, .least = kMinLegRate_rad_s, .periods_a_stride = 1.0};
  Signals trunk{.all = {}, .least = kMinTrunkAccel_m_s2, .periods_a_stride = 2.0};
  for (const SmoothMotion& motion : motions) {
    std::vector<double> signal;
    if (IsLeg(motion.segment)) {
      for (const Eigen::Vector3d& w : motion.w_earth_sensor_in_earth_rad_s) {
        signal.push_back(w.norm());
      }
      legs.all.push_back(std::move(signal));
    } else if (IsTrunk(motion.segment)) {
      for (const Eigen::Vector3d& a : motion.accel_in_earth_m_s2) {
        signal.push_back(a.z());
      }
      trunk.all.push_back(std::move(signal));
    }
  }
  return legs.all.empty() ? trunk : legs;
}

/// At each instant the mean over the signals of their rms around it, over what counts as walking.
std::vector<double> Activity(const Signals& signals, double rate_hz) {
  std::vector<double> mean(signals.all.front().size(), 0.0);
  for (const std::vector<double>& signal : signals.all) {
    std::vector<double> squares(signal.size());
    std::transform(signal.begin(), signal.end(), squares.begin(),
                   [](double value) { return value * value; });
    squares = MovingMean(squares, static_cast<std::size_t>(kActivityWindow_s * rate_hz));
    for (std::size_t i = 0; i < mean.size(); ++i) {
      mean[i] += std::sqrt(std::max(0.0, squares[i])) / signals.least /
                 static_cast<double>(signals.all.size());
    }
  }
  return mean;
}

}  // namespace

Stretch LongestActivity(const std::vector<SmoothMotion>& motions, double rate_hz) {
  const Signals signals = SignalsOf(motions);
  Stretch longest;
  if (signals.all.empty()) {
    return longest;
  }
  const std::vector<double> activity = Activity(signals, rate_hz);
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= activity.size(); ++i) {
    if (i < activity.size() && activity[i] >= 1.0) {
      continue;
    }
    if (i - begin > longest.end - longest.begin) {
      longest = {.begin = begin, .end = i};
    }
    begin = i + 1;
  }
  return longest;
}

std::optional<Gait> FindGait(const std::vector<SmoothMotion>& motions, double rate_hz) {
  const Signals signals = SignalsOf(motions);
  if (signals.all.empty()) {
    return std::nullopt;
  }
  const std::size_t count = signals.all.front().size();
  const auto lag = [&](double stride_s) {
    return static_cast<std::size_t>(std::lround(stride_s * rate_hz / signals.periods_a_stride));
  };
  const std::size_t last = lag(kMaxStride_s) + 1;
  if (count < 3 * last / 2) {
    return std::nullopt;
  }
  std::vector<double> mean(last + 1, 0.0);
  double intensity = 0.0;
  for (const std::vector<double>& signal : signals.all) {
    const std::vector<double> one = Autocorrelation(signal, last);
    for (std::size_t i = 0; i <= last; ++i) {
      mean[i] += one[i] / static_cast<double>(signals.all.size());
    }
    // Somebody who sits and then gets up is no walker: every moment of it must be one.
    intensity += WeakestRms(signal, static_cast<std::size_t>(2.0 * rate_hz)) / signals.least /
                 static_cast<double>(signals.all.size());
  }
  const std::size_t peak = FirstPeak(mean, lag(kMinStride_s), last);
  if (intensity < 1.0 || peak == 0 || mean[peak] < kMinPeriodicity) {
    return std::nullopt;
  }
  return Gait{.stride_s = static_cast<double>(peak) * signals.periods_a_stride / rate_hz,
              .periodicity = mean[peak],
              .intensity = intensity};
}

}  // namespace limbcast::body
