#include "common/filters/position/coil_both_sides.hpp"

#include <algorithm>
#include <cmath>

namespace limbcast::filters {
namespace {

constexpr double kMostNis = 100.0;  // one nonsense reading decides nothing
constexpr double kMoving_m_s = 0.05;

CoilInertialConfig OnSide(CoilInertialConfig config, double z) {
  config.half_space = Eigen::Vector3d(0.0, 0.0, z);
  // The two solve the same pulses, so they take opposite sides however near the boundary these are.
  config.half_space_boundary_rad = 0.0;
  return config;
}

}  // namespace

Result<CoilBothSides> CoilBothSides::Make(CoilInertialConfig config) {
  auto upper = CoilInertialFilter::Make(OnSide(config, 1.0));
  if (!upper) {
    return upper.error();
  }
  auto lower = CoilInertialFilter::Make(OnSide(config, -1.0));
  if (!lower) {
    return lower.error();
  }
  upper->HeedSurprise(false);
  lower->HeedSurprise(false);
  return CoilBothSides(*upper, *lower);
}

CoilUpdateReport CoilBothSides::Update(const sensing::CoilFrame& frame) {
  if (decided_) {
    return upper_leads_ ? upper_.Update(frame) : lower_.Update(frame);
  }
  const CoilUpdateReport up = upper_.Update(frame);
  const CoilUpdateReport down = lower_.Update(frame);
  const double dt_s = has_time_ ? ToSeconds(frame.measured_at - last_at_) : 0.0;
  last_at_ = std::max(last_at_, frame.measured_at);
  has_time_ = true;
  const bool up_tracks = upper_.phase() == CoilPhase::kTracking;
  const bool down_tracks = lower_.phase() == CoilPhase::kTracking;
  if (up.lost != down.lost && (up_tracks || down_tracks)) {
    upper_leads_ = up_tracks;  // a loss of one alone is as good as any NIS
    Decide();
  } else if (up_tracks && down_tracks && dt_s > 0.0) {
    nis_ahead_ += std::min(down.nis, kMostNis) - std::min(up.nis, kMostNis);
    upper_leads_ = nis_ahead_ >= 0.0;
    moving_s_ += filter().state().v_earth_m_s.norm() > kMoving_m_s ? dt_s : 0.0;
    if (std::abs(nis_ahead_) > kDecisiveNis || moving_s_ > kPatience_s) {
      Decide();
    }
  }
  return upper_leads_ ? up : down;
}

// From now on the side is where the track is.
void CoilBothSides::Decide() {
  decided_ = true;
  CoilInertialFilter& left = upper_leads_ ? upper_ : lower_;
  left.ForgetHalfSpace();
  left.HeedSurprise(true);
}

}  // namespace limbcast::filters
