#include "services/gateway/clock_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace limbcast::gateway {
namespace {

using namespace std::chrono_literals;

constexpr Time kHostStart = TimeFromNanoseconds(1'700'000'000'000'000'000);

// A device clock that is behind by `offset` and slow by `skew`, behind a link whose delay is 2 ms
// and something exponential with a mean of 5 ms on top.
struct Device {
  Duration offset = 123456789ns;
  double skew = 0.0;
  std::mt19937 rng{20240517};
  std::exponential_distribution<double> jitter_s{1.0 / 0.005};

  [[nodiscard]] Time TrueHost(Duration device) const {
    return kHostStart + offset + DurationFromSeconds(ToSeconds(device) * (1.0 + skew));
  }
  Time Arrival(Duration device) {
    return TrueHost(device) + 2ms + DurationFromSeconds(jitter_s(rng));
  }
};

TEST(ClockMapTest, FirstPacketGivesTheOffset) {
  ClockMap map;
  EXPECT_FALSE(map.started());
  map.Update(5s, kHostStart);
  EXPECT_EQ(map.ToHost(5s), kHostStart);
  EXPECT_EQ(map.ToHost(6s), kHostStart + 1s);
}

TEST(ClockMapTest, JitterAndSkewAreTakenOut) {
  for (const double skew : {0.0, 50e-6, -300e-6}) {
    Device device{.skew = skew};
    ClockMap map;
    double worst_s = 0.0;
    for (Duration t{}; t < 120s; t += 10ms) {
      map.Update(t, device.Arrival(t));
      const double error_s = ToSeconds(map.ToHost(t) - device.TrueHost(t));
      if (t > 60s) {
        worst_s = std::max(worst_s, std::abs(error_s - 0.002));  // the constant part of the delay
      }
    }
    // In 10 packets a slot, 300 slots a window, the quickest are within some 10 µs of the bound;
    // extrapolated by half a window.
    EXPECT_LT(worst_s, 0.0005) << "skew " << skew;
    EXPECT_NEAR(map.skew(), skew, 20e-6);
    EXPECT_EQ(map.restarts(), 0U);
  }
}

TEST(ClockMapTest, HostTimesNeverGoBackWhileTheDeviceGoesOn) {
  Device device{.skew = 100e-6};
  ClockMap map;
  Time last{};
  for (Duration t{}; t < 60s; t += 4ms) {
    map.Update(t, device.Arrival(t));
    const Time host = map.ToHost(t);
    EXPECT_GE(host, last);
    last = host;
  }
}

TEST(ClockMapTest, OneVerySlowPacketMovesNothing) {
  Device device;
  ClockMap map;
  for (Duration t{}; t < 20s; t += 10ms) {
    map.Update(t, device.TrueHost(t) + 1ms);
  }
  map.Update(20s, device.TrueHost(20s) + 900ms);
  EXPECT_NEAR(ToSeconds(map.ToHost(20s) - device.TrueHost(20s)), 0.001, 1e-6);
}

TEST(ClockMapTest, DeviceThatStartsAgainBeginsAnewMap) {
  ClockMap map;
  for (Duration t{}; t < 10s; t += 10ms) {
    map.Update(100s + t, kHostStart + t);
  }
  map.Update(0s, kHostStart + 10s);
  EXPECT_EQ(map.restarts(), 1U);
  EXPECT_EQ(map.ToHost(0s), kHostStart + 10s);
}

TEST(ClockMapTest, ConfigurationHasRanges) {
  EXPECT_TRUE(Validate(ClockMapConfig{}).ok());
  EXPECT_THAT(Validate({.window_s = 0.0}).error().message,
              ::testing::HasSubstr("clock_map.window_s must be in [1"));
}

}  // namespace
}  // namespace limbcast::gateway
