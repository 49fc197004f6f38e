// Notation: E earth (ENU), S sensor; q_ES turns S into E. Symbols as in the header's error vector.
#include "common/filters/bounded_motion_core.hpp"

#include <cmath>

#include "common/filters/bounded_motion_corrections.hpp"
#include "common/filters/bounded_motion_motion.hpp"
#include "common/filters/bounded_motion_parts.hpp"

namespace limbcast::filters {
using namespace bounded_motion;  // NOLINT: the names of one class, shared by its source files

template <typename Scalar>
BoundedMotionCore<Scalar>::BoundedMotionCore(const BoundedMotionConfig& config) : config_(config) {
  state_->covariance_resets = 0;
  state_->slow_steps = 0;
  state_->rest_time_s = 0;
  state_->low_started = 0;
  state_->low_g.setZero();
  state_->low_a.setZero();
  Start(Eigen::Quaternion<Scalar>::Identity(), Vector3::Zero(), false);
}

template <typename Scalar>
void BoundedMotionCore<Scalar>::Start(const Eigen::Quaternion<Scalar>& q_earth_sensor,
                                      const Vector3& mag_in_earth, bool keep_learned) {
  const auto P_before = state_->P;
  state_->q_ES = q_earth_sensor;
  state_->v_h.setZero();
  state_->p_h.setZero();
  state_->w_ES_S.setZero();
  state_->deviation_hold = 0;
  state_->deviation_mean = 0;
  state_->east_mean = 0;
  state_->east_scatter2 = 0;
  state_->scatter_s = 0;
  state_->b_m.setZero();
  step().ClearSums();
  if (!keep_learned) {
    state_->b_g.setZero();
    state_->b_a.setZero();
    state_->S.setZero();
    state_->m_0.setZero();
    state_->has_field = 0;
  }
  step().ResetCovariance();
  if (keep_learned) {
    const auto keep = [&](int first, int count) {
      for (int column = first; column < first + count; ++column) {
        for (int row = first; row <= column; ++row) {
          state_->P(row, column) = P_before(row, column);
        }
      }
    };
    keep(kBg, 3);
    keep(kBa, 3);
    keep(kS, 9);
  }
  AdoptField(mag_in_earth);
}

template <typename Scalar>
void BoundedMotionCore<Scalar>::AdoptField(const Vector3& mag_in_earth) {
  const Scalar norm = mag_in_earth.norm();
  if (!(norm > 0)) {
    return;
  }
  state_->m_ref = norm;
  state_->m_0 = Vector3(0, std::hypot(mag_in_earth.x(), mag_in_earth.y()), mag_in_earth.z()) / norm;
  state_->has_field = 1;
  state_->east_mean = 0;
  state_->scatter_s = 0;
}

template <typename Scalar>
void BoundedMotionCore<Scalar>::TurnHeading(const Eigen::Quaternion<Scalar>& q_turn) {
  // Velocity, position and the sums so far are in the old heading: they start again.
  state_->q_ES = q_turn * state_->q_ES;
  state_->v_h.setZero();
  state_->p_h.setZero();
  step().ClearSums();
  step().ResetCovariance();
}

template class BoundedMotionStep<double>;
template class BoundedMotionStep<float>;
template class BoundedMotionCore<double>;
template class BoundedMotionCore<float>;

}  // namespace limbcast::filters
