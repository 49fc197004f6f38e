#include "common/simulation/marg_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "common/base/expects.hpp"
#include "common/math/rotation.hpp"

namespace limbcast::simulation {
namespace {

constexpr double kDeg = std::numbers::pi / 180.0;
constexpr double kMilliG_m_s2 = 1e-3 * kGravity_m_s2;
constexpr double kMicroTesla = 1e-6;
constexpr double kBits16 = 1.0 / 32768.0;

TriadErrors DefaultGyro() {
  constexpr double kRange = 2000.0 * kDeg;
  return {.noise_rthz = 0.01 * kDeg,
          .bias = 0.3 * kDeg,
          .bias_walk_rts = 0.001 * kDeg,
          .bias_per_celsius = 0.01 * kDeg,
          .scale = 0.004,
          .misalignment = 0.004,
          .range = kRange,
          .resolution = kRange * kBits16};
}

TriadErrors DefaultAccel() {
  constexpr double kRange = 16.0 * kGravity_m_s2;
  return {.noise_rthz = 0.15 * kMilliG_m_s2,
          .bias = 5.0 * kMilliG_m_s2,
          .bias_walk_rts = 0.01 * kMilliG_m_s2,
          .bias_per_celsius = 0.1 * kMilliG_m_s2,
          .scale = 0.003,
          .misalignment = 0.003,
          .range = kRange,
          .resolution = kRange * kBits16};
}

TriadErrors DefaultMag() {
  return {.noise = 0.3 * kMicroTesla,
          .bias = 0.5 * kMicroTesla,
          .scale = 0.008,
          .misalignment = 0.005,
          .range = 1300.0 * kMicroTesla,
          .resolution = 0.15 * kMicroTesla};
}

TriadErrors Perfect(double range) { return {.range = range}; }

// A cheap sensor: the same with everything larger, and half the range.
TriadErrors Worse(TriadErrors errors, double noise, double bias, double gain) {
  errors.noise_rthz *= noise;
  errors.noise *= noise;
  errors.bias *= bias;
  errors.bias_walk_rts *= noise;
  errors.bias_per_celsius *= noise;
  errors.scale *= gain;
  errors.misalignment *= gain;
  errors.range *= 0.5;
  return errors;
}

Status ValidateTriad(const TriadErrors& errors, const std::string& name) {
  for (const auto& [value, key] :
       {std::pair{errors.noise_rthz, "noise_rthz"}, std::pair{errors.noise, "noise"},
        std::pair{errors.bias, "bias"}, std::pair{errors.bias_walk_rts, "bias_walk_rts"},
        std::pair{errors.bias_per_celsius, "bias_per_celsius"}, std::pair{errors.scale, "scale"},
        std::pair{errors.misalignment, "misalignment"}, std::pair{errors.range, "range"},
        std::pair{errors.resolution, "resolution"}}) {
    if (!(value >= 0.0) || !std::isfinite(value)) {
      return Error{ErrorCode::kInvalidArgument,
                   name + "." + key + " must be 0 or more, is " + std::to_string(value)};
    }
  }
  return Ok();
}

}  // namespace

IdealMarg MakeIdealMarg(const RigidMotion& segment, const SensorMounting& mounting,
                        const MagneticWorld& world) {
  const RigidMotion at = AtPoint(segment, mounting.p_segment_sensor_m);
  const Eigen::Matrix3d R_earth_sensor =
      at.R_earth_local * mounting.q_segment_sensor.toRotationMatrix();
  const Eigen::Vector3d force_m_s2 =
      at.a_earth_local_m_s2 + kGravity_m_s2 * Eigen::Vector3d::UnitZ();
  IdealMarg ideal;
  ideal.q_earth_sensor = math::QuaternionFromMatrix(R_earth_sensor);
  ideal.p_earth_sensor_m = at.p_earth_local_m;
  ideal.gyro_rad_s = R_earth_sensor.transpose() * at.w_earth_local_rad_s;
  ideal.accel_m_s2 = R_earth_sensor.transpose() * force_m_s2;
  ideal.mag_tesla = R_earth_sensor.transpose() * world.At(at.p_earth_local_m);
  return ideal;
}

MargErrors MakeMargErrors(NoisePreset preset) {
  MargErrors errors;
  const TriadErrors gyro = DefaultGyro();
  const TriadErrors accel = DefaultAccel();
  const TriadErrors mag = DefaultMag();
  switch (preset) {
    case NoisePreset::kIdeal:
      errors.gyro = Perfect(gyro.range);
      errors.accel = Perfect(accel.range);
      errors.mag = Perfect(mag.range);
      break;
    case NoisePreset::kDefault:
      errors.gyro = gyro;
      errors.accel = accel;
      errors.mag = mag;
      errors.warm_up_celsius = 4.0;
      break;
    case NoisePreset::kPoor:
      errors.gyro = Worse(gyro, 3.0, 6.0, 4.0);
      errors.accel = Worse(accel, 3.0, 8.0, 4.0);
      errors.mag = Worse(mag, 3.0, 6.0, 4.0);
      errors.warm_up_celsius = 10.0;
      break;
  }
  return errors;
}

Status Validate(const MargErrors& errors) {
  if (Status ok = ValidateTriad(errors.gyro, "gyro"); !ok) {
    return ok;
  }
  if (Status ok = ValidateTriad(errors.accel, "accel"); !ok) {
    return ok;
  }
  if (Status ok = ValidateTriad(errors.mag, "mag"); !ok) {
    return ok;
  }
  if (!(errors.warm_up_time_s > 0.0)) {
    return Error{ErrorCode::kInvalidArgument,
                 "warm_up_time_s must be more than 0, is " + std::to_string(errors.warm_up_time_s)};
  }
  return Ok();
}

MargModel::MargModel(const MargErrors& errors, double rate_hz, const Random& random)
    : random_(random), dt_s_(1.0 / rate_hz), errors_(errors) {
  Expects(rate_hz > 0.0 && Validate(errors).ok(), "a rate and validated errors");
  gyro_ = MakeTriad(errors.gyro);
  accel_ = MakeTriad(errors.accel);
  mag_ = MakeTriad(errors.mag);
}

MargModel::Triad MargModel::MakeTriad(const TriadErrors& errors) {
  Triad triad;
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index col = 0; col < 3; ++col) {
      const double limit = row == col ? errors.scale : errors.misalignment;
      triad.gain(row, col) += random_.Uniform(-limit, limit);
    }
  }
  triad.start_bias = random_.Uniform3(errors.bias);
  triad.per_celsius = random_.Uniform3(errors.bias_per_celsius);
  triad.sigma = std::hypot(errors.noise, errors.noise_rthz * std::sqrt(0.5 / dt_s_));
  triad.walk_sigma = errors.bias_walk_rts * std::sqrt(dt_s_);
  triad.range = errors.range;
  triad.resolution = errors.resolution;
  return triad;
}

Eigen::Vector3f MargModel::ReadTriad(Triad& triad, const Eigen::Vector3d& ideal,
                                     double warmer_celsius, bool& saturated) {
  Eigen::Vector3d reading = triad.gain * ideal;
  if (triad.walk_sigma > 0.0) {
    triad.walk += triad.walk_sigma * random_.Gaussian3();
  }
  triad.bias = triad.start_bias + triad.walk + warmer_celsius * triad.per_celsius;
  reading += triad.bias;
  if (triad.sigma > 0.0) {
    reading += triad.sigma * random_.Gaussian3();
  }
  for (double& axis : reading) {
    if (triad.resolution > 0.0) {
      axis = triad.resolution * std::nearbyint(axis / triad.resolution);
    }
    if (triad.range > 0.0 && std::abs(axis) >= triad.range) {
      axis = std::clamp(axis, -triad.range, triad.range);
      saturated = true;
    }
  }
  return reading.cast<float>();
}

void MargModel::Read(const IdealMarg& ideal, sensing::MargSample& sample) {
  const double warmer_celsius =
      errors_.warm_up_celsius * (1.0 - std::exp(-elapsed_s_ / errors_.warm_up_time_s));
  const auto read = [&](Triad& triad, const Eigen::Vector3d& truth, sensing::MargFlag flag) {
    bool saturated = false;
    Eigen::Vector3f reading = ReadTriad(triad, truth, warmer_celsius, saturated);
    sample.flags |= saturated ? flag : 0U;
    return reading;
  };
  sample.gyro_rad_s = read(gyro_, ideal.gyro_rad_s, sensing::kGyroSaturated);
  sample.accel_m_s2 = read(accel_, ideal.accel_m_s2, sensing::kAccelSaturated);
  sample.mag_tesla = read(mag_, ideal.mag_tesla, sensing::kMagSaturated);
  sample.temperature_celsius = static_cast<float>(errors_.start_celsius + warmer_celsius);
  elapsed_s_ += dt_s_;
}

}  // namespace limbcast::simulation
