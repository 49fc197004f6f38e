#include "services/posture/alignment_blend.hpp"

#include "common/math/rotation.hpp"

namespace limbcast::posture {

void AlignmentBlend::Start(const Eigen::Quaterniond& q_old, const Eigen::Quaterniond& q_new,
                           Time at, Duration span) {
  active_ = span > Duration::zero();
  left_rad_ = math::LogSO3(q_old * q_new.conjugate());
  from_ = at;
  span_ = span;
}

Eigen::Quaterniond AlignmentBlend::Apply(const Eigen::Quaterniond& q_new, Time at) {
  const double u = active_ ? ToSeconds(at - from_) / ToSeconds(span_) : 1.0;
  if (u >= 1.0 || u < 0.0) {  // over, or the stream began anew
    active_ = false;
    return q_new;
  }
  return math::ExpSO3((1.0 - u * u * (3.0 - 2.0 * u)) * left_rad_) * q_new;
}

}  // namespace limbcast::posture
