#include "tests/golden/golden_trace.hpp"

#include <fmt/format.h>

#include <fstream>
#include <sstream>
#include <utility>
#include <vector>

#include "common/base/expects.hpp"
#include "common/filters/filter_factory.hpp"
#include "services/gateway/drivers/replay/recording_reader.hpp"

namespace limbcast::golden {
namespace {

constexpr std::size_t kEvery = 10;

}  // namespace

Result<tool::OrientationTrial> LoadInput(const std::filesystem::path& folder) {
  const auto recording = gateway::ReadRecording(folder / kInput);
  if (!recording) {
    return recording.error();
  }
  auto trials = tool::TrialsOf(*recording, "golden");
  if (trials.size() != 1) {
    return Error{ErrorCode::kCorruptData, std::string(kInput) + " must hold one sensor with truth"};
  }
  return std::move(trials.front());
}

Trace Compute(const tool::OrientationTrial& input, const std::string& filter) {
  // In double, whatever the filter is shipped with: rounding is not what a trace is for.
  const std::vector<filters::Setting> in_double = {{"precision", "double"}};
  auto made = filters::MakeFilter(filter, in_double);
  if (!made.ok()) {
    made = filters::MakeFilter(filter);  // which knows nothing else
  }
  Expects(made.ok(), "a filter of the factory");
  const tool::OrientationResult result = tool::EvaluateTrial(input, **made);
  Trace trace;
  for (std::size_t row = 0; row < result.q_earth_sensor.size(); row += kEvery) {
    trace.row.push_back(row);
    trace.q_earth_sensor.push_back(result.q_earth_sensor[row]);
  }
  return trace;
}

std::string Format(const Trace& trace) {
  std::string text = "row,w,x,y,z\n";
  for (std::size_t i = 0; i < trace.row.size(); ++i) {
    const Eigen::Quaterniond& q = trace.q_earth_sensor[i];
    text += fmt::format("{},{:.10f},{:.10f},{:.10f},{:.10f}\n", trace.row[i], q.w(), q.x(), q.y(),
                        q.z());
  }
  return text;
}

Result<Trace> Load(const std::filesystem::path& file) {
  std::ifstream lines(file);
  std::string line;
  if (!std::getline(lines, line) || line != "row,w,x,y,z") {
    return Error{ErrorCode::kCorruptData, file.string() + " is not a golden trace"};
  }
  Trace trace;
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::size_t row = 0;
    double w = 0.0;
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;
    char comma = ',';
    if (!(cells >> row >> comma >> w >> comma >> x >> comma >> y >> comma >> z)) {
      return Error{ErrorCode::kCorruptData, file.string() + ": not a row: " + line};
    }
    trace.row.push_back(row);
    trace.q_earth_sensor.emplace_back(w, x, y, z);
  }
  return trace;
}

}  // namespace limbcast::golden
