// Writes the golden traces anew. By hand, on purpose, never by a test or CI: see README.md.
#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "common/filters/filter_factory.hpp"
#include "services/gateway/drivers/simulator/simulator_driver.hpp"
#include "tests/golden/golden_trace.hpp"
#include "tools/limbcast/evaluate/orientation_report.hpp"
#include "tools/limbcast/report/report_text.hpp"

namespace {

using namespace limbcast;

constexpr const char* kUsage =
    "usage: make_golden_traces [--input] FOLDER [FILTER...]\n"
    "  writes FOLDER/<filter>.csv for the filters named, or all; --input writes the recording "
    "too\n";

int Fail(const Error& error) {
  fmt::print(stderr, "make_golden_traces: {}\n", error.message);
  return 2;
}

std::string Cells(const Eigen::Vector3f& v) {
  return fmt::format(",{:.9g},{:.9g},{:.9g}", v.x(), v.y(), v.z());
}

// The simulated person as the demo has it, a shorter N-pose apart.
Result<std::string> SimulateInput() {
  gateway::SimulatorConfig config;
  config.rate_hz = 50.0;
  config.duration_s = 20.0;
  config.n_pose_s = 2.0;
  auto driver = gateway::SimulatorDriver::Make(config);
  if (!driver) {
    return driver.error();
  }
  std::string text =
      "# Simulated: limbcast's own person, left fore arm, default noise, iron, seed 20260101.\n"
      "time_s,sensor,gyro_x_rad_s,gyro_y_rad_s,gyro_z_rad_s,accel_x_m_s2,accel_y_m_s2,accel_z_m_s2,"
      "mag_x_tesla,mag_y_tesla,mag_z_tesla,truth_q_earth_sensor_w,truth_q_earth_sensor_x,"
      "truth_q_earth_sensor_y,truth_q_earth_sensor_z\n";
  gateway::Batch batch;
  int row = 0;
  for (auto step = (*driver)->Next(batch); step && *step == gateway::DriverStep::kData;
       step = (*driver)->Next(batch)) {
    for (std::size_t i = 0; i < batch.marg.size(); ++i) {
      if (batch.truth[i].segment != body::Segment::kLeftForeArm) {
        continue;
      }
      const sensing::MargSample& s = batch.marg[i];
      const Eigen::Quaterniond& q = batch.truth[i].q_earth_sensor;
      text += fmt::format("{:.2f},left_fore_arm{}{}{},{:.9f},{:.9f},{:.9f},{:.9f}\n",
                          row++ / config.rate_hz, Cells(s.gyro_rad_s), Cells(s.accel_m_s2),
                          Cells(s.mag_tesla), q.w(), q.x(), q.y(), q.z());
    }
  }
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  const bool input = !words.empty() && words.front() == "--input";
  if (input) {
    words.erase(words.begin());
  }
  if (words.empty() || words.front().starts_with('-')) {
    fmt::print(stderr, "{}", kUsage);
    return 2;
  }
  const std::filesystem::path folder = words.front();
  std::vector<std::string> names(words.begin() + 1, words.end());
  if (names.empty()) {
    names.assign(filters::FilterNames().begin(), filters::FilterNames().end());
  }
  if (input) {
    const auto text = SimulateInput();
    if (!text) {
      return Fail(text.error());
    }
    if (const Status saved = tool::SaveText(folder / golden::kInput, *text); !saved) {
      return Fail(saved.error());
    }
  }
  const auto trial = golden::LoadInput(folder);
  if (!trial) {
    return Fail(trial.error());
  }
  for (const std::string& name : names) {
    if (const auto made = filters::MakeFilter(name); !made) {
      return Fail(made.error());
    }
    const std::string text = golden::Format(golden::Compute(*trial, name));
    if (const Status saved = tool::SaveText(folder / (name + ".csv"), text); !saved) {
      return Fail(saved.error());
    }
    fmt::print("{}\n", (folder / (name + ".csv")).string());
  }
  return 0;
}
