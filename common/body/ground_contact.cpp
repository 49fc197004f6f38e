#include "common/body/ground_contact.hpp"

#include <algorithm>
#include <cmath>

namespace limbcast::body {

void GroundContact::Observe(const GroundContactInput& input) {
  height_m_ = input.height_m;
  const double rate = input.rate_rad_s / config_.restless_rate_rad_s;
  const double accel = input.accel_m_s2 / config_.restless_accel_m_s2;
  const double gain = -std::expm1(-input.dt_s / config_.smoothing_s);
  const double motion = rate * rate + accel * accel;
  motion_ += gain * ((std::isfinite(motion) ? motion : 0.0) - motion_);
}

double GroundContact::unrest() const {
  const double height = height_m_ / config_.restless_height_m;
  return height * height + motion_;
}

void GroundContact::Decide(double speed_m_s) {
  touches_ = height_m_ < (touches_ ? config_.height_off_m : config_.height_on_m) &&
             speed_m_s < (touches_ ? config_.speed_off_m_s : config_.speed_on_m_s);
  trust_ = touches_ ? std::max(0.0, 1.0 - height_m_ / config_.height_off_m) *
                          std::max(0.0, 1.0 - speed_m_s / config_.speed_off_m_s) / (1.0 + unrest())
                    : 0.0;
}

void GroundContact::Reset() {
  height_m_ = 0.0;
  motion_ = 0.0;
  touches_ = false;
  trust_ = 0.0;
}

}  // namespace limbcast::body
