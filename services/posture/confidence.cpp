#include "services/posture/confidence.hpp"

#include <algorithm>
#include <cmath>

namespace limbcast::posture {

float Confidence(const ConfidenceInput& input) {
  constexpr float kSigmaOfHalf_rad = 0.2F;
  constexpr float kNotAligned = 0.5F;
  constexpr float kDegraded = 0.7F;
  constexpr float kDisturbed = 0.8F;

  if (!std::isfinite(input.sigma_rad) || !std::isfinite(input.alignment_quality)) {
    return 0.0F;
  }
  const float ratio = input.sigma_rad / kSigmaOfHalf_rad;
  float confidence = 1.0F / (1.0F + ratio * ratio);
  if (input.age > Duration::zero()) {
    confidence *= static_cast<float>(std::exp(-ToSeconds(input.age)));
  }
  const float quality = input.aligned ? std::clamp(input.alignment_quality, 0.0F, 1.0F) : 0.0F;
  confidence *= kNotAligned + (1.0F - kNotAligned) * quality;
  confidence *= input.degraded ? kDegraded : 1.0F;
  confidence *= input.disturbed ? kDisturbed : 1.0F;
  return std::clamp(confidence, 0.0F, 1.0F);
}

float SigmaOf(const Eigen::Matrix3f& cov_rad2) { return std::sqrt(cov_rad2.trace()); }

}  // namespace limbcast::posture
