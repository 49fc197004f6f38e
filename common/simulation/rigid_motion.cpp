#include "common/simulation/rigid_motion.hpp"

#include <cmath>

namespace limbcast::simulation {
namespace {

struct Columns {
  Eigen::Vector3d value;
  Eigen::Vector3d rate;
  Eigen::Vector3d accel;
};

Columns Split(const Jet3& a) {
  return {{a.x.value, a.y.value, a.z.value},
          {a.x.rate, a.y.rate, a.z.rate},
          {a.x.accel, a.y.accel, a.z.accel}};
}

}  // namespace

RigidMotion MovingPoint(const Jet3& p_earth_m) {
  RigidMotion frame;
  const Columns p = Split(p_earth_m);
  frame.p_earth_local_m = p.value;
  frame.v_earth_local_m_s = p.rate;
  frame.a_earth_local_m_s2 = p.accel;
  return frame;
}

void RotateAbout(RigidMotion& frame, int axis, const Jet& angle_rad) {
  const int second = (axis + 1) % 3;
  const int third = (axis + 2) % 3;
  const double c = std::cos(angle_rad.value);
  const double s = std::sin(angle_rad.value);
  Eigen::Matrix3d& R = frame.R_earth_local;
  const Eigen::Vector3d n = R.col(axis);
  const Eigen::Vector3d b = R.col(second);
  const Eigen::Vector3d d = R.col(third);
  R.col(second) = c * b + s * d;
  R.col(third) = c * d - s * b;
  const Eigen::Vector3d turn_rad_s = angle_rad.rate * n;
  frame.wd_earth_local_rad_s2 += angle_rad.accel * n + frame.w_earth_local_rad_s.cross(turn_rad_s);
  frame.w_earth_local_rad_s += turn_rad_s;
}

RigidMotion AtPoint(const RigidMotion& frame, const Eigen::Vector3d& p_local_m) {
  RigidMotion moved = frame;
  const Eigen::Vector3d r_m = frame.R_earth_local * p_local_m;
  const Eigen::Vector3d w_cross_r_m_s = frame.w_earth_local_rad_s.cross(r_m);
  moved.p_earth_local_m += r_m;
  moved.v_earth_local_m_s += w_cross_r_m_s;
  moved.a_earth_local_m_s2 +=
      frame.wd_earth_local_rad_s2.cross(r_m) + frame.w_earth_local_rad_s.cross(w_cross_r_m_s);
  return moved;
}

void SetAxes(RigidMotion& frame, const Jet3& x, const Jet3& y, const Jet3& z) {
  const Columns cx = Split(x);
  const Columns cy = Split(y);
  const Columns cz = Split(z);
  frame.R_earth_local << cx.value, cy.value, cz.value;
  // ω = ½ Σ eᵢ × ėᵢ, the axial vector of ṘRᵀ; the same with ëᵢ is the axial vector of R̈Rᵀ.
  frame.w_earth_local_rad_s =
      0.5 * (cx.value.cross(cx.rate) + cy.value.cross(cy.rate) + cz.value.cross(cz.rate));
  frame.wd_earth_local_rad_s2 =
      0.5 * (cx.value.cross(cx.accel) + cy.value.cross(cy.accel) + cz.value.cross(cz.accel));
}

Jet3 Origin(const RigidMotion& frame) {
  const auto jet = [&frame](Eigen::Index i) {
    return Jet{frame.p_earth_local_m[i], frame.v_earth_local_m_s[i], frame.a_earth_local_m_s2[i]};
  };
  return {jet(0), jet(1), jet(2)};
}

}  // namespace limbcast::simulation
