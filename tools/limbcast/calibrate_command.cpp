#include "tools/limbcast/calibrate_command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/config/durable_file.hpp"
#include "common/runtime/stop_signal.hpp"
#include "common/runtime/system_clock.hpp"
#include "common/units/units.hpp"
#include "services/gateway/calibration_file.hpp"
#include "services/gateway/drivers/replay/recording_reader.hpp"
#include "tools/limbcast/calibrate/calibration_report.hpp"
#include "tools/limbcast/calibrate/live_collector.hpp"
#include "tools/limbcast/calibrate/sensor_samples.hpp"
#include "tools/limbcast/calibrate_body_command.hpp"
#include "tools/limbcast/live_bus.hpp"
#include "tools/limbcast/report/report_text.hpp"

namespace limbcast::tool {
namespace {

struct CalibrateOptions {
  std::string recording;
  std::string sensor;
  std::string out;
  std::string report;
  std::string method = "fits";
  double gravity_m_s2 = 9.80665;
  double field_ut = 0.0;
  double known_rotation_deg = 0.0;
  double declination_deg = 0.0;
  double seconds = 0.0;  // 0 = until Ctrl-C or enough
  bool level = false;
};

Result<std::vector<SensorSamples>> FromRecording(const CalibrateOptions& options) {
  const auto recording = gateway::ReadRecording(options.recording);
  if (!recording) {
    return recording.error();
  }
  std::vector<sensing::SensorInfo> sensors;
  sensors.reserve(recording->sensors.size());
  for (const gateway::RecordedSensor& sensor : recording->sensors) {
    sensors.push_back(sensor.info);
  }
  auto sorted = SamplesBySensor(sensors, recording->marg, options.sensor);
  if (!sorted) {
    return sorted;
  }
  for (const gateway::RecordedSensor& recorded : recording->sensors) {
    for (SensorSamples& sensor : *sorted) {
      if (recorded.segment && sensor.info.sensor_uid == recorded.info.sensor_uid) {
        sensor.limb = std::string(body::ToString(*recorded.segment));
      }
    }
  }
  return sorted;
}

// What comes over the bus while the person turns the sensor (guided), or stands still.
Result<std::vector<SensorSamples>> FromGateway(const service::ServiceCommandLine& line,
                                               const CalibrateOptions& options, bool guided) {
  runtime::StopSignal stop;
  const auto bus = OpenLiveBus(line);
  if (!bus) {
    return bus.error();
  }
  auto collector = LiveCollector::Make(**bus, options.sensor);
  if (!collector) {
    return collector.error();
  }
  const bool terminal = isatty(STDERR_FILENO) != 0;
  const double period_s = terminal ? 0.5 : 2.0;
  double waited_s = 0.0;
  while (!stop.WaitFor(DurationFromSeconds(period_s)) &&
         (options.seconds <= 0.0 || waited_s < options.seconds)) {
    waited_s += period_s;
    if (guided) {
      fmt::print(stderr, "{}{}{}", terminal ? "\r\033[K" : "", (*collector)->Line(),
                 terminal ? "" : "\n");
      std::fflush(stderr);
    }
    if (guided && (*collector)->complete()) {
      break;
    }
  }
  fmt::print(stderr, "{}", terminal && guided ? "\n" : "");
  return (*collector)->Take(guided);
}

Result<std::vector<SensorSamples>> Gather(const service::ServiceCommandLine& line,
                                          const CalibrateOptions& options, bool guided) {
  return options.recording.empty() ? FromGateway(line, options, guided) : FromRecording(options);
}

int CalibrateSensors(const service::ServiceCommandLine& line, const CalibrateOptions& options) {
  const auto sensors = Gather(line, options, true);
  if (!sensors) {
    return line.Fail(sensors.error());
  }
  sensing::CalibrationSettings settings;
  settings.method = options.method == "papers" ? sensing::CalibrationMethod::kPapers
                                               : sensing::CalibrationMethod::kFits;
  settings.gravity_m_s2 = options.gravity_m_s2;
  settings.field_tesla = units::TeslaFromMicrotesla(options.field_ut);
  settings.level_positions = options.level;
  settings.known_rotation_rad = units::RadFromDeg(options.known_rotation_deg);
  const runtime::SystemClock clock;
  std::vector<NamedReport> reports;
  std::size_t refused = 0;
  for (const SensorSamples& sensor : *sensors) {
    NamedReport named{.name = sensor.Name(),
                      .report = sensing::CalibrateSensor(sensor.samples, settings)};
    fmt::print("{}", CalibrationText(named));
    named.report.calibration.serial = sensor.info.serial;
    named.report.calibration.calibrated_at = clock.Now();
    if (named.report.calibration.empty()) {
      ++refused;
    } else if (!options.out.empty()) {
      if (Status saved = gateway::SaveCalibration(options.out, named.report.calibration); !saved) {
        return line.Fail(saved.error());
      }
      fmt::print("  -> {}/{}\n", options.out, gateway::CalibrationFileName(sensor.info.serial));
    }
    reports.push_back(std::move(named));
  }
  if (!options.report.empty()) {
    if (Status saved = SaveText(options.report, CalibrationHtml(reports, settings)); !saved) {
      return line.Fail(saved.error());
    }
  }
  if (refused == reports.size()) {
    return line.Fail({ErrorCode::kInvalidArgument, "no sensor could be calibrated, see above"});
  }
  return 0;
}

int CalibrateSession(const service::ServiceCommandLine& line, CalibrateOptions options) {
  options.seconds = options.seconds > 0.0 ? options.seconds : 5.0;
  const auto sensors = Gather(line, options, false);
  if (!sensors) {
    return line.Fail(sensors.error());
  }
  const sensing::SessionConfig config{
      .window_s = options.seconds,
      .declination_rad = units::RadFromDeg(options.declination_deg),
      .expected_field_tesla = units::TeslaFromMicrotesla(options.field_ut)};
  std::vector<NamedReference> references;
  for (const SensorSamples& sensor : *sensors) {
    NamedReference named{.name = sensor.Name(), .reference = {}, .refusal = {}};
    if (const auto reference = sensing::MeasureSessionReference(sensor.samples, config)) {
      named.reference = *reference;
    } else {
      named.refusal = reference.error().message;
    }
    references.push_back(std::move(named));
  }
  fmt::print("{}", SessionText(references, config));
  if (!options.out.empty()) {
    const Result<std::string> settings = SessionToml(references, config);
    if (!settings) {
      return line.Fail(settings.error());
    }
    if (const Status saved = config::WriteDurably(options.out, *settings); !saved) {
      return line.Fail(saved.error());
    }
    fmt::print("-> {}\n", options.out);
  }
  return 0;
}

void AddCommon(CLI::App& app, CalibrateOptions& options) {
  app.add_option("--recording", options.recording,
                 "Use this instead of a running gateway: HDF5, Xsens text, CSV")
      ->type_name("PATH");
  app.add_option("--sensor", options.sensor, "Only this one: label or serial number")
      ->type_name("NAME");
  app.add_option("--field-ut", options.field_ut, "Strength of the local field; 0 = not known")
      ->check(CLI::Range(0.0, 100.0));
  app.add_option("--seconds", options.seconds, "How long to listen to a gateway")
      ->check(CLI::Range(0.0, 3600.0));
}

}  // namespace

SubCommand AddCalibrateCommand(service::ServiceCommandLine& line) {
  const auto options = std::make_shared<CalibrateOptions>();
  CLI::App* app = line.app().add_subcommand("calibrate", "Calibrate sensors, a session, or a body");
  app->require_subcommand(1);
  CLI::App* sensor = app->add_subcommand(
      "sensor",
      "Scale, misalignment and offsets of sensors: hold some twenty poses still for 2 s each, all "
      "sides up once, and turn in between.\nExample:\n  limbcast calibrate sensor --recording "
      "turns.csv --out calibrations --report calibration.html");
  AddCommon(*sensor, *options);
  sensor->add_option("--out", options->out, "Folder for the files (gateway.calibration_folder)")
      ->type_name("DIR");
  sensor->add_option("--report", options->report, "HTML page with coverage maps")
      ->type_name("FILE");
  sensor->add_option("--method", options->method, "fits (default), or the papers' procedures")
      ->check(CLI::IsMember({"fits", "papers"}));
  sensor
      ->add_option("--known-rotation-deg", options->known_rotation_deg,
                   "Papers' gyro scale: size of the turns about one axis each, from rest to rest")
      ->check(CLI::Range(10.0, 3600.0));
  sensor->add_option("--gravity", options->gravity_m_s2, "Local gravity, m/s²")
      ->check(CLI::Range(9.7, 9.9));
  sensor->add_flag("--level", options->level,
                   "Each side of the case lay on a level surface: axes are those of the case");
  CLI::App* session = app->add_subcommand(
      "session",
      "Local gravity and field from the first seconds at rest, and which sensors see it "
      "disturbed.\nExample:\n  limbcast calibrate session --recording walk.hdf5 "
      "--declination-deg 4.2 --out session.toml\n  limbcast-fusion --config fusion.toml --config "
      "session.toml");
  AddCommon(*session, *options);
  session
      ->add_option("--out", options->out, "Write what was measured as settings of limbcast-fusion")
      ->type_name("FILE.toml");
  session
      ->add_option("--declination-deg", options->declination_deg,
                   "Magnetic north's bearing from true north, east positive")
      ->check(CLI::Range(-180.0, 180.0));
  const SubCommand body = AddCalibrateBody(*app, line);
  return {.app = app, .run = [&line, options, session, body] {
            if (body.app->parsed()) {
              return body.run();
            }
            return session->parsed() ? CalibrateSession(line, *options)
                                     : CalibrateSensors(line, *options);
          }};
}

}  // namespace limbcast::tool
