// The simulated person as the shipped filters see it: is it a fair stand-in for a real one?

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <memory>
#include <numbers>
#include <unordered_map>

#include "common/filters/filter_factory.hpp"
#include "common/math/rotation.hpp"
#include "services/gateway/drivers/simulator/simulator_driver.hpp"

namespace limbcast::gateway {
namespace {

constexpr double kDeg = std::numbers::pi / 180.0;

struct Tracked {
  std::unique_ptr<filters::OrientationFilter> filter;
  double square_rad2 = 0.0;
  double worst_rad = 0.0;
  int count = 0;

  [[nodiscard]] double rms_rad() const { return std::sqrt(square_rad2 / count); }
};

// Runs one filter for each sensor and returns them by sensor, in the order of the description.
std::vector<Tracked> Track(const SimulatorConfig& config, std::string_view filter_name) {
  auto driver = *SimulatorDriver::Make(config);
  std::unordered_map<SensorUid, std::size_t> index;
  std::vector<Tracked> tracked;
  for (const auto& info : driver->Describe().sensors) {
    index[info.sensor_uid] = tracked.size();
    tracked.push_back({*filters::MakeFilter(filter_name)});
  }
  Batch batch;
  while (*driver->Next(batch) == DriverStep::kData) {
    for (std::size_t i = 0; i < batch.marg.size(); ++i) {
      Tracked& t = tracked[index.at(batch.marg[i].sensor_uid)];
      static_cast<void>(t.filter->Update(batch.marg[i]));
      if (t.filter->estimate().started) {
        const double error_rad = math::AngleBetween_rad(t.filter->estimate().q_earth_sensor,
                                                        batch.truth[i].q_earth_sensor);
        t.square_rad2 += error_rad * error_rad;
        t.worst_rad = std::max(t.worst_rad, error_rad);
        ++t.count;
      }
    }
  }
  return tracked;
}

void Print(const SimulatorConfig& config, const std::vector<Tracked>& tracked) {
  const auto infos = (*SimulatorDriver::Make(config))->Describe().sensors;
  for (std::size_t i = 0; i < tracked.size(); ++i) {
    std::cout << infos[i].label << ": " << tracked[i].rms_rad() / kDeg << " deg rms, "
              << tracked[i].worst_rad / kDeg << " max\n";
  }
}

TEST(FilteredPersonTest, TqtStaysWithinThreeDegreesBesideIron) {
  SimulatorConfig config;
  config.duration_s = 30.0;
  const auto tracked = Track(config, "tqt");
  Print(config, tracked);
  for (const Tracked& t : tracked) {
    EXPECT_GT(t.count, 2900);
    EXPECT_LE(t.rms_rad(), 3.0 * kDeg);
  }
}

TEST(FilteredPersonTest, BmfStaysWithinOneAndAHalfDegreesBesideIron) {
  SimulatorConfig config;
  config.duration_s = 60.0;
  const auto tracked = Track(config, "bmf");
  Print(config, tracked);
  double square_rad2 = 0.0;
  int count = 0;
  for (const Tracked& t : tracked) {
    EXPECT_LE(t.rms_rad(), 3.0 * kDeg);
    square_rad2 += t.square_rad2;
    count += t.count;
  }
  EXPECT_LE(std::sqrt(square_rad2 / count), 1.5 * kDeg);
}

TEST(FilteredPersonTest, TqtIsBetterWithoutErrorsAndIron) {
  SimulatorConfig config;
  config.duration_s = 30.0;
  const auto disturbed = Track(config, "tqt");
  config.iron = false;
  config.noise = simulation::NoisePreset::kIdeal;
  const auto clean = Track(config, "tqt");
  double sum_rad = 0.0;
  double clean_sum_rad = 0.0;
  for (std::size_t i = 0; i < clean.size(); ++i) {
    sum_rad += disturbed[i].rms_rad();
    clean_sum_rad += clean[i].rms_rad();
  }
  EXPECT_LT(clean_sum_rad, sum_rad);
}

}  // namespace
}  // namespace limbcast::gateway
