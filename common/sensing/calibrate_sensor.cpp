#include "common/sensing/calibrate_sensor.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "common/sensing/known_rotation.hpp"
#include "common/sensing/null_and_scale.hpp"
#include "common/sensing/sphere_coverage.hpp"
#include "common/sensing/triad_alignment.hpp"

namespace limbcast::sensing {
namespace {

using Vectors = std::vector<Eigen::Vector3d>;

constexpr std::size_t kMostReadings = 4000;  // of the magnetometer; more add time and little else

Vectors MeansAtRest(const std::vector<RestPose>& poses) {
  Vectors means;
  for (const RestPose& pose : poses) {
    means.push_back(pose.accel_m_s2);
  }
  return means;
}

// Means of specific force over 0.1 s in which the sensor turns slowly: what is left of the hand's
// own acceleration is for the robust fit.
Vectors MeansWhileTurning(std::span<const MargSample> samples) {
  constexpr double kBlock_s = 0.1;
  constexpr float kSlow_rad_s = 2.0F;
  Vectors means;
  std::size_t begin = 0;
  while (begin < samples.size()) {
    const Time until = samples[begin].measured_at + DurationFromSeconds(kBlock_s);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    bool good = true;
    std::size_t end = begin;
    for (; end < samples.size() && samples[end].measured_at < until; ++end) {
      good = good && HasGyroAndAccel(samples[end]) && samples[end].gyro_rad_s.norm() < kSlow_rad_s;
      sum += samples[end].accel_m_s2.cast<double>();
    }
    end = std::max(end, begin + 1);
    if (good) {
      means.push_back(sum / static_cast<double>(end - begin));
    }
    begin = end;
  }
  return means;
}

Vectors MagReadings(std::span<const MargSample> samples) {
  Vectors readings;
  for (const MargSample& sample : samples) {
    if (HasFreshMag(sample)) {
      readings.push_back(sample.mag_tesla.cast<double>());
    }
  }
  const std::size_t stride = readings.size() / kMostReadings + 1;
  for (std::size_t i = 0; i * stride < readings.size(); ++i) {
    readings[i] = readings[i * stride];
  }
  readings.resize((readings.size() + stride - 1) / stride);
  return readings;
}

void Take(ChannelReport& channel, const Result<TriadFit>& fit) {
  if (fit) {
    channel.fit = *fit;
  } else {
    channel.refusal = fit.error().message;
  }
}

TriadFit PaperFit(const TriadCalibration& triad, const Vectors& readings, double norm,
                  std::string method) {
  SphereCoverage coverage;
  for (const Eigen::Vector3d& r : readings) {
    coverage.Add(triad.Apply(r));
  }
  return {.calibration = triad,
          .method = std::move(method),
          .residual_before = LengthResidual(readings, {}, norm),
          .residual_after = LengthResidual(readings, triad, norm),
          .sigma_scale = LengthResidual(readings, triad, norm),
          .coverage = coverage.share(),
          .points = readings.size()};
}

// Eq. (31) on top of the null at rest.
void ScaleGyroByTurns(std::span<const MargSample> samples, const std::vector<RestPose>& poses,
                      double known_rad, SensorReport& report) {
  const auto scales = GyroScalesFromTurns(samples, poses, known_rad);
  if (!scales) {
    report.gyro.refusal = scales.error().message;
    return;
  }
  TriadFit fit = *report.calibration.gyro;
  fit.calibration.matrix = scales->asDiagonal();
  fit.method = "known-rotation";
  fit.coverage = 1.0;
  report.gyro.fit = fit;
}

void CalibrateByPapers(std::span<const MargSample> samples, const std::vector<RestPose>& poses,
                       const CalibrationSettings& settings, SensorReport& report) {
  const auto accel = SixPositionAccel(report.accel.readings, settings.gravity_m_s2);
  if (accel) {
    report.accel.fit =
        PaperFit(*accel, report.accel.readings, settings.gravity_m_s2, "six-positions");
  } else {
    report.accel.refusal = accel.error().message;
  }
  const auto mag = MinMaxMag(report.mag.readings, settings.field_tesla);
  if (mag) {
    report.mag.fit = PaperFit(*mag, report.mag.readings, settings.field_tesla, "min-max");
  } else {
    report.mag.refusal = mag.error().message;
  }
  if (poses.empty()) {
    report.gyro.refusal = "no time at rest: lay the sensor down for some seconds";
  } else if (settings.known_rotation_rad > 0.0) {
    ScaleGyroByTurns(samples, poses, settings.known_rotation_rad, report);
  } else {
    report.gyro.refusal = "scale factors need a known rotation";
  }
}

void FitAccel(std::span<const MargSample> samples, const CalibrationSettings& settings,
              SensorReport& report) {
  EllipsoidConfig config = settings.accel;
  config.norm = settings.gravity_m_s2;
  Take(report.accel, FitEllipsoid(report.accel.readings, config, " up"));
  if (!report.accel.fit && !settings.level_positions) {
    config.max_residual = settings.mag.max_residual;
    Vectors turning = MeansWhileTurning(samples);
    if (auto fit = FitEllipsoid(turning, config, " up")) {
      fit->method = "ellipsoid-moving";
      report.accel = {.fit = *fit, .refusal = {}, .readings = std::move(turning)};
    } else {
      report.accel.refusal =
          "at rest: " + report.accel.refusal + "; while turning slowly: " + fit.error().message;
    }
  }
  if (!report.accel.fit || !settings.level_positions) {
    return;
  }
  TriadCalibration& triad = report.accel.fit->calibration;
  Vectors corrected;
  for (const Eigen::Vector3d& r : report.accel.readings) {
    corrected.push_back(triad.Apply(r));
  }
  if (const auto R_case_accel = AlignToCase(corrected)) {
    triad.matrix = *R_case_accel * triad.matrix;
    report.accel.fit->method = "ellipsoid-level";
  } else {
    report.accel = {.fit = std::nullopt,
                    .refusal = R_case_accel.error().message,
                    .readings = std::move(report.accel.readings)};
  }
}

void FitMag(const std::vector<RestPose>& poses, const CalibrationSettings& settings,
            SensorReport& report) {
  EllipsoidConfig config = settings.mag;
  config.norm = settings.field_tesla;
  Take(report.mag, FitEllipsoid(report.mag.readings, config, " along the field"));
  if (!report.mag.fit || !report.accel.fit) {
    return;
  }
  TriadFit& fit = *report.mag.fit;
  std::vector<GravityAndField> seen;
  for (const RestPose& pose : poses) {
    if (pose.mag_count > 0) {
      seen.push_back({.accel_m_s2 = report.accel.fit->calibration.Apply(pose.accel_m_s2),
                      .mag_tesla = fit.calibration.Apply(pose.mag_tesla)});
    }
  }
  const auto aligned = AlignMagToAccel(seen, settings.max_alignment_sigma_rad);
  if (!aligned) {
    report.mag.refusal = "axes not aligned with the accelerometer's: " + aligned.error().message;
    return;
  }
  fit.calibration.matrix = aligned->R_accel_mag * fit.calibration.matrix;
  fit.method = "ellipsoid-aligned";
  report.dip_rad = aligned->dip_rad;
}

std::vector<CarriedDirection> CarriedGravity(const std::vector<RestPose>& poses,
                                             const TriadCalibration& accel) {
  std::vector<CarriedDirection> carried;
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    // From the middle of one rest to the middle of the next, where the nulls are known best.
    carried.push_back({.begin = (poses[i].begin + poses[i].end) / 2,
                       .end = (poses[i + 1].begin + poses[i + 1].end) / 2,
                       .before = accel.Apply(poses[i].accel_m_s2).normalized(),
                       .after = accel.Apply(poses[i + 1].accel_m_s2).normalized(),
                       .null_before_rad_s = poses[i].gyro_rad_s,
                       .null_after_rad_s = poses[i + 1].gyro_rad_s});
  }
  return carried;
}

std::vector<CarriedDirection> CarriedField(std::span<const MargSample> samples,
                                           const TriadCalibration& mag,
                                           const Eigen::Vector3d& null_rad_s) {
  constexpr double kStretch_s = 1.0;
  std::vector<CarriedDirection> carried;
  const auto field = [&](std::size_t i) {
    return Eigen::Vector3d(mag.Apply(samples[i].mag_tesla.cast<double>()).normalized());
  };
  std::optional<std::size_t> begin;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!HasGyroAndAccel(samples[i])) {
      begin.reset();  // nothing is carried over a hole
    } else if (HasFreshMag(samples[i])) {
      if (!begin) {
        begin = i;
      } else if (ToSeconds(samples[i].measured_at - samples[*begin].measured_at) >= kStretch_s) {
        carried.push_back({.begin = *begin,
                           .end = i,
                           .before = field(*begin),
                           .after = field(i),
                           .null_before_rad_s = null_rad_s,
                           .null_after_rad_s = null_rad_s});
        begin = i;
      }
    }
  }
  return carried;
}

bool AllThere(std::span<const MargSample> samples, const CarriedDirection& span) {
  return std::all_of(samples.begin() + static_cast<std::ptrdiff_t>(span.begin),
                     samples.begin() + static_cast<std::ptrdiff_t>(span.end) + 1, HasGyroAndAccel);
}

void FitGyroScale(std::span<const MargSample> samples, const std::vector<RestPose>& poses,
                  const CalibrationSettings& settings, SensorReport& report) {
  if (!report.accel.fit && !report.mag.fit) {
    report.gyro.refusal = "scale: needs the accelerometer or the magnetometer fitted";
  }
  if (report.accel.fit) {
    auto carried = CarriedGravity(poses, report.accel.fit->calibration);
    std::erase_if(carried, [&](const CarriedDirection& span) { return !AllThere(samples, span); });
    Take(report.gyro, FitGyro(samples, carried, settings.gyro));
  }
  const TriadFit at_rest = *report.calibration.gyro;
  if (!report.gyro.fit && report.mag.fit) {
    const auto carried =
        CarriedField(samples, report.mag.fit->calibration, at_rest.calibration.offset);
    if (auto fit = FitGyro(samples, carried, settings.gyro)) {
      fit->method = "carried-field";
      report.gyro.fit = *fit;
    } else {
      report.gyro.refusal += (report.accel.fit ? "; by the field: " : "by the field: ");
      report.gyro.refusal += fit.error().message;
    }
  }
  if (report.gyro.fit) {
    report.gyro.refusal.clear();
    report.gyro.fit->calibration.offset = at_rest.calibration.offset;
    report.gyro.fit->sigma_offset = at_rest.sigma_offset;
  }
}

// Mean over all rest, with the standard error of the poses' means.
TriadFit NullAtRest(const std::vector<RestPose>& poses) {
  TriadFit fit;
  fit.method = "null-at-rest";
  double count = 0.0;
  for (const RestPose& pose : poses) {
    const auto more = static_cast<double>(pose.end - pose.begin);
    count += more;
    fit.calibration.offset += (pose.gyro_rad_s - fit.calibration.offset) * (more / count);
  }
  Eigen::Vector3d square = Eigen::Vector3d::Zero();
  for (const RestPose& pose : poses) {
    square += (pose.gyro_rad_s - fit.calibration.offset).cwiseAbs2();
  }
  const auto n = static_cast<double>(poses.size());
  fit.sigma_offset = n > 1.0 ? std::sqrt(square.maxCoeff() / (n * (n - 1.0))) : 0.0;
  fit.sigma_scale = 1.0;  // not fitted
  fit.points = poses.size();
  return fit;
}

double MeanTemperature(std::span<const MargSample> samples) {
  double sum = 0.0;
  double count = 0.0;
  for (const MargSample& sample : samples) {
    if (!sample.Has(kTemperatureMissing) && std::isfinite(sample.temperature_celsius)) {
      sum += static_cast<double>(sample.temperature_celsius);
      count += 1.0;
    }
  }
  return count > 0.0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

SensorReport CalibrateSensor(std::span<const MargSample> samples,
                             const CalibrationSettings& settings) {
  SensorReport report;
  const std::vector<RestPose> poses = FindRestPoses(samples, settings.rest);
  report.poses = poses.size();
  for (const RestPose& pose : poses) {
    report.rest_s += ToSeconds(samples[pose.end - 1].measured_at - samples[pose.begin].measured_at);
  }
  report.accel.readings = MeansAtRest(poses);
  report.mag.readings = MagReadings(samples);
  if (!poses.empty()) {
    report.calibration.gyro = NullAtRest(poses);
  }
  if (settings.method == CalibrationMethod::kPapers) {
    CalibrateByPapers(samples, poses, settings, report);
  } else {
    FitAccel(samples, settings, report);
    FitMag(poses, settings, report);
    if (poses.empty()) {
      report.gyro.refusal = "no time at rest: lay the sensor down for some seconds";
    } else {
      FitGyroScale(samples, poses, settings, report);
    }
  }
  if (report.gyro.fit) {
    report.calibration.gyro = report.gyro.fit;
  } else {
    report.gyro.fit = report.calibration.gyro;
  }
  report.calibration.accel = report.accel.fit;
  report.calibration.mag = report.mag.fit;
  report.calibration.temperature_celsius = MeanTemperature(samples);
  return report;
}

}  // namespace limbcast::sensing
