#include "common/sensing/sensor_calibration.hpp"

#include <Eigen/LU>

#include "common/sensing/axis_words.hpp"

namespace limbcast::sensing {
namespace {

void ApplyTo(Eigen::Vector3f& reading, const std::optional<TriadFit>& fit, bool missing) {
  if (fit && !missing) {
    reading = fit->calibration.Apply(reading.cast<double>()).cast<float>();
  }
}

Status ValidateTriad(const std::optional<TriadFit>& fit, const std::string& name) {
  if (!fit) {
    return Ok();
  }
  const TriadCalibration& triad = fit->calibration;
  if (!triad.matrix.allFinite() || !triad.offset.allFinite()) {
    return Error{ErrorCode::kCorruptData, name + " has a number that is not finite"};
  }
  constexpr double kMin = 0.1;
  constexpr double kMax = 10.0;
  const double determinant = triad.matrix.determinant();
  if (!(determinant >= kMin && determinant <= kMax)) {
    return Error{
        ErrorCode::kCorruptData,
        name + ".matrix must have a determinant in [0.1, 10], is " + NumberText(determinant, 6)};
  }
  return Ok();
}

}  // namespace

std::string_view ToText(CalibrationGrade grade) {
  switch (grade) {
    case CalibrationGrade::kGood:
      return "good";
    case CalibrationGrade::kFair:
      return "fair";
    case CalibrationGrade::kUsable:
      break;
  }
  return "usable";
}

CalibrationGrade GradeOf(const TriadFit& fit) {
  constexpr double kGoodSigma = 0.001;
  constexpr double kGoodResidual = 0.005;
  constexpr double kFairSigma = 0.002;
  constexpr double kFairResidual = 0.015;
  if (fit.sigma_scale <= kGoodSigma && fit.residual_after <= kGoodResidual) {
    return CalibrationGrade::kGood;
  }
  return fit.sigma_scale <= kFairSigma && fit.residual_after <= kFairResidual
             ? CalibrationGrade::kFair
             : CalibrationGrade::kUsable;
}

void SensorCalibration::Apply(MargSample& sample) const {
  ApplyTo(sample.gyro_rad_s, gyro, sample.Has(kGyroMissing));
  ApplyTo(sample.accel_m_s2, accel, sample.Has(kAccelMissing));
  ApplyTo(sample.mag_tesla, mag, sample.Has(kMagMissing));
}

std::string SensorCalibration::Summary() const {
  std::string text;
  const auto add = [&text](const std::optional<TriadFit>& fit, const char* name) {
    if (fit) {
      text += text.empty() ? "" : ", ";
      text += std::string(name) + ' ' + std::string(ToText(GradeOf(*fit)));
    }
  };
  add(gyro, "gyro");
  add(accel, "accel");
  add(mag, "mag");
  return text;
}

Status Validate(const SensorCalibration& calibration) {
  Status status = ValidateTriad(calibration.gyro, "gyro");
  status = status ? ValidateTriad(calibration.accel, "accel") : status;
  return status ? ValidateTriad(calibration.mag, "mag") : status;
}

}  // namespace limbcast::sensing
