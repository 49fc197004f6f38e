#include "tests/unit/common/sensing/calibration_scene.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/math/rotation.hpp"

namespace limbcast::sensing::scene {
namespace {

class Recorder {
 public:
  Recorder(const simulation::MargErrors& errors, std::uint64_t seed)
      : model_(errors, kRate_hz, simulation::Random(seed)) {}

  void Read(const Eigen::Quaterniond& q, const Eigen::Vector3d& rate) {
    MargSample sample;
    sample.sensor_uid = SensorUid{1};
    sample.measured_at =
        Time{} + DurationFromSeconds(static_cast<double>(samples.size()) / kRate_hz);
    model_.Read(IdealAt(q, rate), sample);
    samples.push_back(sample);
  }
  std::vector<MargSample> samples;

 private:
  simulation::MargModel model_;
};

}  // namespace

simulation::IdealMarg IdealAt(const Eigen::Quaterniond& q, const Eigen::Vector3d& rate) {
  const Eigen::Vector3d field(0.0, std::cos(kDip_rad), -std::sin(kDip_rad));
  simulation::IdealMarg ideal;
  ideal.q_earth_sensor = q;
  ideal.gyro_rad_s = rate;
  ideal.accel_m_s2 = q.conjugate() * Eigen::Vector3d(0.0, 0.0, simulation::kGravity_m_s2);
  ideal.mag_tesla = q.conjugate() * (kField_tesla * field);
  return ideal;
}

Handling RandomPoses(std::size_t count, std::uint64_t seed) {
  simulation::Random random(seed, "poses");
  Handling handling;
  for (std::size_t i = 0; i < count; ++i) {
    handling.poses.push_back(random.Rotation());
  }
  return handling;
}

Handling GuidedPoses(bool level_faces, std::uint64_t seed) {
  constexpr double kByHand_rad = 0.1;  // about each axis
  simulation::Random random(seed, "guided");
  std::vector<Eigen::Vector3d> directions;
  for (int parts = 1; parts <= 3; ++parts) {  // faces, edges, corners
    for (int code = 0; code < 27; ++code) {
      const Eigen::Vector3i d(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1);
      if (d.cwiseAbs().sum() == parts) {
        directions.push_back(d.cast<double>().normalized());
      }
    }
  }
  Handling handling;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const auto up = Eigen::Quaterniond::FromTwoVectors(directions[i], Eigen::Vector3d::UnitZ());
    const double heading_rad = random.Uniform(-std::numbers::pi, std::numbers::pi);
    const Eigen::Vector3d off_rad = random.Uniform3(level_faces && i < 6 ? 0.0 : kByHand_rad);
    handling.poses.push_back(math::ExpSO3(off_rad) *
                             math::ExpSO3(heading_rad * Eigen::Vector3d::UnitZ()) * up);
  }
  return handling;
}

Handling SixFaces(double heading_rad, double tilt_rad, std::uint64_t seed) {
  simulation::Random random(seed, "faces");
  Handling handling;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      const Eigen::Vector3d face = sign * Eigen::Vector3d::Unit(axis);
      const auto lay = Eigen::Quaterniond::FromTwoVectors(face, Eigen::Vector3d::UnitZ());
      handling.poses.push_back(math::ExpSO3(random.Uniform3(tilt_rad)) *
                               math::ExpSO3(heading_rad * Eigen::Vector3d::UnitZ()) * lay);
    }
  }
  return handling;
}

std::vector<MargSample> Read(const Handling& handling, const simulation::MargErrors& errors,
                             std::uint64_t seed) {
  Recorder recorder(errors, seed);
  const auto rest = static_cast<int>(handling.rest_s * kRate_hz);
  const auto turn = static_cast<int>(handling.turn_s * kRate_hz);
  for (std::size_t i = 0; i < handling.poses.size(); ++i) {
    const Eigen::Quaterniond& q = handling.poses[i];
    for (int k = 0; k < rest; ++k) {
      recorder.Read(q, Eigen::Vector3d::Zero());
    }
    if (i + 1 == handling.poses.size()) {
      break;
    }
    const Eigen::Vector3d phi =
        math::LogSO3(math::Canonical(q.conjugate() * handling.poses[i + 1]));
    for (int k = 0; k < turn; ++k) {  // Flash & Hogan 1985: 10τ³ − 15τ⁴ + 6τ⁵
      const double t = static_cast<double>(k) / turn;
      const double s = t * t * t * (10.0 + t * (6.0 * t - 15.0));
      const double ds = 30.0 * t * t * (1.0 + t * (t - 2.0)) / handling.turn_s;
      recorder.Read(q * math::ExpSO3(s * phi), ds * phi);
    }
  }
  return recorder.samples;
}

simulation::MargErrors FactoryErrors() {
  auto errors = simulation::MakeMargErrors(simulation::NoisePreset::kDefault);
  errors.warm_up_celsius = 0.0;
  for (simulation::TriadErrors* triad : {&errors.gyro, &errors.accel, &errors.mag}) {
    triad->scale = 0.02;
    triad->misalignment = 0.02;
  }
  errors.gyro.bias = std::numbers::pi / 180.0;
  errors.accel.bias = 0.02 * simulation::kGravity_m_s2;
  errors.mag.bias = 20e-6;
  return errors;
}

SensorTruth TruthOf(simulation::MargErrors errors, std::uint64_t seed) {
  for (simulation::TriadErrors* triad : {&errors.gyro, &errors.accel, &errors.mag}) {
    triad->noise = triad->noise_rthz = triad->bias_walk_rts = 0.0;
    triad->resolution = triad->range = 0.0;
  }
  simulation::MargModel model(errors, kRate_hz, simulation::Random(seed));
  const auto read = [&model](const Eigen::Vector3d& ideal) {
    MargSample sample;
    simulation::IdealMarg marg;
    marg.gyro_rad_s = marg.accel_m_s2 = ideal;
    marg.mag_tesla = 1e-5 * ideal;
    model.Read(marg, sample);
    return sample;
  };
  SensorTruth truth;
  const MargSample zero = read(Eigen::Vector3d::Zero());
  truth.gyro.bias = zero.gyro_rad_s.cast<double>();
  truth.accel.bias = zero.accel_m_s2.cast<double>();
  truth.mag.bias = zero.mag_tesla.cast<double>();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const MargSample one = read(Eigen::Vector3d::Unit(axis));
    truth.gyro.gain.col(axis) = one.gyro_rad_s.cast<double>() - truth.gyro.bias;
    truth.accel.gain.col(axis) = one.accel_m_s2.cast<double>() - truth.accel.bias;
    truth.mag.gain.col(axis) = (one.mag_tesla.cast<double>() - truth.mag.bias) / 1e-5;
  }
  return truth;
}

LeftErrors ErrorsLeft(const Eigen::Matrix3d& matrix, const Eigen::Matrix3d& gain,
                      const Eigen::Matrix3d& R_common) {
  const Eigen::Matrix3d left = R_common.transpose() * matrix * gain;  // the identity if perfect
  LeftErrors errors;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double length = left.col(axis).norm();
    errors.scale = std::max(errors.scale, std::abs(length - 1.0));
    const double cosine = std::min(1.0, left(axis, axis) / length);
    errors.misalignment_rad = std::max(errors.misalignment_rad, std::acos(cosine));
  }
  return errors;
}

Eigen::Matrix3d CommonRotation(const Eigen::Matrix3d& matrix, const Eigen::Matrix3d& gain) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix * gain,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

}  // namespace limbcast::sensing::scene
