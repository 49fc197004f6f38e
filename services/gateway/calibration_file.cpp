#include "services/gateway/calibration_file.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <ctime>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <system_error>

#include "common/config/config_file.hpp"
#include "common/config/durable_file.hpp"
#include "common/config/toml_text.hpp"

namespace limbcast::gateway {

namespace {

constexpr std::size_t kMaxText = 64;
constexpr double kAnyNumber = 1e9;

std::string DateText(Time time) {
  const std::time_t seconds = ToNanoseconds(time) / 1'000'000'000;
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", utc);
}

void Add(std::string& toml, const char* name, const char* unit, const char* residual_unit,
         const std::optional<sensing::TriadFit>& fit) {
  if (!fit) {
    return;
  }
  const Eigen::Matrix3d& M = fit->calibration.matrix;
  const Eigen::Vector3d& b = fit->calibration.offset;
  toml += fmt::format(
      "\n[{}]\nmethod = {}\ngrade = \"{}\"\n"
      "matrix = [{}, {}, {}, {}, {}, {}, {}, {}, {}]  # by rows\noffset_{} = [{}, {}, {}]\n"
      "residual_before{} = {}\nresidual_after{} = {}\nsigma_scale = {}\nsigma_offset = {}\n"
      "coverage = {}\npoints = {}\n",
      name, config::Quoted(fit->method), sensing::ToText(sensing::GradeOf(*fit)), M(0, 0), M(0, 1),
      M(0, 2), M(1, 0), M(1, 1), M(1, 2), M(2, 0), M(2, 1), M(2, 2), unit, b.x(), b.y(), b.z(),
      residual_unit, fit->residual_before, residual_unit, fit->residual_after, fit->sigma_scale,
      fit->sigma_offset, fit->coverage, fit->points);
}

void Require(const config::Section& section, const std::string& key) {
  if (!section.Has(key)) {
    section.Fail(key, "is missing");
  }
}

std::optional<sensing::TriadFit> ReadFit(const config::ConfigFile& file, const char* name,
                                         const std::string& unit,
                                         const std::string& residual_unit) {
  if (!file.Root().Has(name)) {
    return std::nullopt;
  }
  const config::Section section = file.Get(name);
  sensing::TriadFit fit;
  Require(section, "matrix");
  Require(section, "offset_" + unit);
  const auto matrix =
      section.ReadNumbers("matrix", std::vector<double>(9, 0.0), -kAnyNumber, kAnyNumber, 9);
  const auto offset = section.ReadNumbers("offset_" + unit, std::vector<double>(3, 0.0),
                                          -kAnyNumber, kAnyNumber, 3);
  fit.calibration.matrix =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(matrix.data());
  fit.calibration.offset = Eigen::Map<const Eigen::Vector3d>(offset.data());
  fit.method = section.Read("method", "", kMaxText);
  (void)section.Read("grade", "", kMaxText);  // for people; it follows from the rest
  fit.residual_before = section.Read("residual_before" + residual_unit, 0.0, 0.0, kAnyNumber);
  fit.residual_after = section.Read("residual_after" + residual_unit, 0.0, 0.0, kAnyNumber);
  fit.sigma_scale = section.Read("sigma_scale", 0.0, 0.0, kAnyNumber);
  fit.sigma_offset = section.Read("sigma_offset", 0.0, 0.0, kAnyNumber);
  fit.coverage = section.Read("coverage", 0.0, 0.0, 1.0);
  fit.points = section.Read("points", std::size_t{0}, std::size_t{0},
                            std::size_t{std::numeric_limits<std::int64_t>::max()});
  return fit;
}

Result<sensing::SensorCalibration> LoadFile(const std::filesystem::path& path,
                                            const std::string& serial) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    return Error{ErrorCode::kNotFound, path.string() + ": no such file"};
  }
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  auto read = CalibrationFromToml(text, path.string());
  if (read && read->serial != serial) {
    return Error{ErrorCode::kCorruptData,
                 path.string() + ": is of sensor " + read->serial + ", expected " + serial};
  }
  return read;
}

}  // namespace

std::string CalibrationFileName(const std::string& serial) {
  std::string name;
  for (const char c : serial) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain =
        std::isalnum(byte) != 0 || c == '-' || c == '_' || (c == '.' && !name.empty());
    name += plain ? std::string(1, c) : fmt::format("%{:02X}", byte);
  }
  return name + ".toml";
}

std::string CalibrationToToml(const sensing::SensorCalibration& calibration) {
  std::string toml = fmt::format(
      "# Calibration of one sensor: corrected = matrix * (reading - offset). Residuals of accel "
      "and "
      "mag: fraction of the length.\n\n[sensor]\nformat = 1\nserial = {}\ndate = \"{}\"\n"
      "calibrated_at_ns = {}\n",
      config::Quoted(calibration.serial), DateText(calibration.calibrated_at),
      ToNanoseconds(calibration.calibrated_at));
  if (std::isfinite(calibration.temperature_celsius)) {
    toml += fmt::format("temperature_celsius = {}\n", calibration.temperature_celsius);
  }
  Add(toml, "gyro", "rad_s", "_rad", calibration.gyro);
  Add(toml, "accel", "m_s2", "", calibration.accel);
  Add(toml, "mag", "tesla", "", calibration.mag);
  return toml + "\n[end]\nwhole = true\n";
}

Result<sensing::SensorCalibration> CalibrationFromToml(std::string_view text,
                                                       const std::string& name) {
  const auto file = config::ConfigFile::Parse(text, name);
  if (!file) {
    return Error{ErrorCode::kCorruptData, file.error().message};
  }
  const bool whole = file->Get("end").Read("whole", false);
  if (!whole) {
    return Error{ErrorCode::kCorruptData, name + ": is not whole, its last line is missing"};
  }
  const config::Section sensor = file->Get("sensor");
  Require(sensor, "serial");
  (void)sensor.Read("format", 1, 1, 1);
  (void)sensor.Read("date", "", kMaxText);
  sensing::SensorCalibration calibration;
  calibration.serial = sensor.Read("serial", "", kMaxText);
  calibration.calibrated_at =
      TimeFromNanoseconds(sensor.Read("calibrated_at_ns", std::int64_t{0}, std::int64_t{0},
                                      std::numeric_limits<std::int64_t>::max()));
  calibration.temperature_celsius = sensor.Has("temperature_celsius")
                                        ? sensor.Read("temperature_celsius", 0.0, -273.15, 1000.0)
                                        : std::numeric_limits<double>::quiet_NaN();
  calibration.gyro = ReadFit(*file, "gyro", "rad_s", "_rad");
  calibration.accel = ReadFit(*file, "accel", "m_s2", "");
  calibration.mag = ReadFit(*file, "mag", "tesla", "");
  if (const Status read = file->Finish(); !read) {
    return Error{ErrorCode::kCorruptData, read.error().message};
  }
  if (const Status valid = sensing::Validate(calibration); !valid) {
    return Error{ErrorCode::kCorruptData, name + ": " + valid.error().message};
  }
  return calibration;
}

Result<sensing::SensorCalibration> LoadCalibration(const std::filesystem::path& folder,
                                                   const std::string& serial) {
  return LoadFile(folder / CalibrationFileName(serial), serial);
}

Result<sensing::SensorCalibration> LoadOldCalibration(const std::filesystem::path& folder,
                                                      const std::string& serial) {
  return LoadFile(folder / (CalibrationFileName(serial) + ".old"), serial);
}

Status SaveCalibration(const std::filesystem::path& folder,
                       const sensing::SensorCalibration& calibration) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  const std::filesystem::path path = folder / CalibrationFileName(calibration.serial);
  const std::string text = CalibrationToToml(calibration);
  if (const auto read = CalibrationFromToml(text, path.string()); !read) {
    return Error{ErrorCode::kUnavailable, read.error().message};
  }
  // Only a good file becomes the old one: a spoiled one would push out the last that can be read.
  const bool good = LoadFile(path, calibration.serial).ok();
  const std::string old = good ? path.string() + ".old" : "";
  return config::ReplaceDurably(path, text, old);
}

}  // namespace limbcast::gateway
