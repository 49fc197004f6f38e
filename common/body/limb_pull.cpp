#include "common/body/limb_pull.hpp"

#include <Eigen/Cholesky>
#include <array>

#include "common/math/rotation.hpp"

namespace limbcast::body {
namespace {

// Of the limb, outermost first: where the sensor is, then its parents up to the trunk.
struct Chain {
  std::array<Segment, 4> segments{};
  std::size_t size = 0;
};

bool IsLimb(Segment segment) { return IsArm(segment) || IsLeg(segment); }

Chain ChainOf(Segment segment) {
  Chain chain;
  for (Segment at = segment; IsLimb(at) && chain.size < chain.segments.size();) {
    chain.segments[chain.size++] = at;
    const auto parent = ParentOf(at);
    if (!parent) {
      break;
    }
    at = *parent;
  }
  return chain;
}

}  // namespace

bool PullLimb(const LimbPullConfig& config, const LimbPosition& position,
              const PerSegment<float>& sigma_rad, BodyPose& pose) {
  const Chain chain = ChainOf(position.segment);
  const std::size_t from = Index(position.from);
  bool measured = chain.size > 0 && pose.known[from] && position.p_sensor_sensor_m.allFinite() &&
                  position.cov_m2.allFinite();
  for (std::size_t k = 0; k < chain.size; ++k) {
    measured = measured && pose.known[Index(chain.segments[k])];
  }
  if (!measured) {
    return false;
  }
  std::array<Eigen::Vector3d, 4> lever_E_m;
  std::array<double, 4> var_rad2{};
  const std::size_t outermost = Index(position.segment);
  Eigen::Vector3d outer_end_m = pose.p_earth_segment_m[outermost] +
                                pose.q_earth_segment[outermost] * position.p_segment_sensor_m;
  const Eigen::Vector3d kinematic_m = outer_end_m - pose.p_earth_segment_m[from] -
                                      pose.q_earth_segment[from] * position.p_from_sensor_m;
  const Eigen::Vector3d d_m = position.p_sensor_sensor_m - kinematic_m;
  Eigen::Matrix3d S =
      position.cov_m2 + config.sigma_trunk_m * config.sigma_trunk_m * Eigen::Matrix3d::Identity();
  for (std::size_t k = 0; k < chain.size; ++k) {
    const std::size_t i = Index(chain.segments[k]);
    lever_E_m[k] = outer_end_m - pose.p_earth_segment_m[i];
    outer_end_m = pose.p_earth_segment_m[i];
    const double sigma = static_cast<double>(sigma_rad[i]);
    var_rad2[k] = sigma * sigma + config.sigma_alignment_rad * config.sigma_alignment_rad;
    S += var_rad2[k] * (lever_E_m[k].squaredNorm() * Eigen::Matrix3d::Identity() -
                        lever_E_m[k] * lever_E_m[k].transpose());
  }
  const Eigen::LLT<Eigen::Matrix3d> factor(S);
  const Eigen::Vector3d weighted = factor.solve(d_m);
  const double nis = d_m.dot(weighted);
  if (factor.info() != Eigen::Success ||
      !(nis <= config.most_sigmas * config.most_sigmas)) {  // NaN is refused, too
    return false;
  }
  for (std::size_t k = 0; k < chain.size; ++k) {
    Eigen::Quaterniond& q = pose.q_earth_segment[Index(chain.segments[k])];
    q = (math::ExpSO3(var_rad2[k] * lever_E_m[k].cross(weighted)) * q).normalized();
  }
  return true;
}

}  // namespace limbcast::body
