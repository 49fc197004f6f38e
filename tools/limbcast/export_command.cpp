#include "tools/limbcast/export_command.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <memory>
#include <mutex>
#include <string>

#include "common/runtime/stop_signal.hpp"
#include "tools/limbcast/export/angle_table.hpp"
#include "tools/limbcast/live_bus.hpp"
#include "tools/limbcast/report/report_text.hpp"

namespace limbcast::tool {
namespace {

struct ExportOptions {
  std::uint32_t body_id = 0;  // 0 = the first one heard
  double seconds = 10.0;
  std::string out;
};

// Collects on the bus' threads what the command writes at its end.
class Collector {
 public:
  explicit Collector(std::uint32_t body_id) : body_id_{body_id} {}

  void On(const body::Skeleton& skeleton) {
    const std::lock_guard lock(mutex_);
    if (body_id_.value == 0) {
      body_id_ = skeleton.body_id;
    }
    // A skeleton in which nothing is measured yet answers a probe and holds no angle.
    if (skeleton.body_id == body_id_ && body::AnyTracked(skeleton)) {
      body::FillJointAngles(skeleton, frame_);
      table_.Add(frame_);
    }
  }
  [[nodiscard]] BodyId body_id() const { return body_id_; }
  [[nodiscard]] const AngleTable& table() const { return table_; }

 private:
  std::mutex mutex_;
  BodyId body_id_;
  body::JointAngleFrame frame_;
  AngleTable table_;
};

int ExportAngles(const service::ServiceCommandLine& line, const ExportOptions& options) {
  const runtime::StopSignal stop;  // Ctrl-C ends the recording and writes it
  const auto bus = OpenLiveBus(line);
  if (!bus) {
    return line.Fail(bus.error());
  }
  Collector collector(options.body_id);
  auto reader = (*bus)->MakeReader<body::Skeleton>(
      {.on_sample = [&](const body::Skeleton& skeleton,
                        const bus::SampleInfo&) { collector.On(skeleton); },
       .on_disposed = {}});
  if (!reader) {
    return line.Fail(reader.error());
  }
  stop.WaitFor(DurationFromSeconds(options.seconds));
  reader->reset();  // no callback runs any more

  if (collector.table().rows() == 0) {
    return line.Fail(
        {ErrorCode::kTimeout,
         fmt::format("no skeleton of {} in {} s",
                     options.body_id == 0 ? "any body" : fmt::format("body {}", options.body_id),
                     options.seconds)});
  }
  const std::string text = collector.table().Text(
      AngleFormatOf(options.out),
      fmt::format("limbcast joint angles of body {}", collector.body_id().value));
  fmt::print(stderr, "{} frames of body {}\n", collector.table().rows(), collector.body_id().value);
  if (options.out.empty()) {
    fmt::print("{}", text);
    return 0;
  }
  if (const Status saved = SaveText(options.out, text); !saved) {
    return line.Fail(saved.error());
  }
  return 0;
}

}  // namespace

SubCommand AddExportCommand(service::ServiceCommandLine& line) {
  const auto options = std::make_shared<ExportOptions>();
  CLI::App* app = line.app().add_subcommand(
      "export",
      "Write what a running pipeline says of a person to a file.\nExample:\n  limbcast export "
      "angles --body 1 --seconds 30 --out walk.csv");
  app->require_subcommand(1);
  CLI::App* angles = app->add_subcommand(
      "angles", "Joint angles (ISB), a row for each skeleton: CSV, or OpenSim's .mot by its name");
  angles->add_option("--body", options->body_id, "Number of the body (default: the first heard)");
  angles->add_option("--seconds", options->seconds, "How long to listen")
      ->check(CLI::Range(0.1, 86400.0));
  angles->add_option("--out", options->out, "File, .csv or .mot (default: CSV to standard output)");
  return {.app = app, .run = [&line, options] { return ExportAngles(line, *options); }};
}

}  // namespace limbcast::tool
