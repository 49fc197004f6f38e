#include "common/filters/position/coil_inertial_config.hpp"

#include "common/base/range.hpp"

namespace limbcast::filters {

Status Validate(const CoilInertialConfig& c) {
  return CheckRanges(
      "coil filter: ",
      {{"source.radius_m", c.source.radius_m, 0.005, 1.0},
       {"source.turns", c.source.turns, 1.0, 1e4},
       {"source.moment_factor", c.source.moment_factor.minCoeff(), 0.5, 2.0},
       {"source.moment_factor", c.source.moment_factor.maxCoeff(), 0.5, 2.0},
       {"source.centre_m", c.source.centre_m.cwiseAbs().maxCoeff(), 0.0, 1.0},
       {"tone_window_s", c.tone_window_s, 0.05, 2.0},
       {"sigma_mag_tesla", c.sigma_mag_tesla, 1e-10, 1e-5},
       {"relative_field_error", c.relative_field_error, 0.0, 0.2},
       {"walk_background_tesla_rts", c.walk_background_tesla_rts, 0.0, 1e-4},
       {"walk_beside_gradient", c.walk_beside_gradient, 0.0, 1.0},
       {"walk_gradient_per_m", c.walk_gradient_per_m, 0.0, 10.0},
       {"mag_calibration_error", c.mag_calibration_error, 0.0, 0.1},
       {"start_sigma_gradient_tesla_m", c.start_sigma_gradient_tesla_m, 0.0, 1e-4},
       {"emitter_quiet_s", c.emitter_quiet_s, 0.0, 1.0},
       {"start_sigma_emitter_mag_offset_tesla", c.start_sigma_emitter_mag_offset_tesla, 0.0, 1e-4},
       {"iterations", static_cast<double>(c.iterations), 1.0, 10.0},
       {"max_step", c.max_step, 1e-3, 1.0},
       {"sigma_gravity_m_s2", c.sigma_gravity_m_s2, 0.1, 100.0},
       {"gravity_period_s", c.gravity_period_s, 0.0, 10.0},
       {"sigma_background_tesla", c.sigma_background_tesla, 1e-8, 1e-3},
       {"background_period_s", c.background_period_s, 0.0, 10.0},
       {"half_space", c.half_space ? c.half_space->norm() : 1.0, 0.999, 1.001},
       {"half_space_boundary_rad", c.half_space_boundary_rad, 0.0, 1.5},
       {"start_sigma_v_m_s", c.start_sigma_v_m_s, 1e-3, 10.0},
       {"start_sigma_tilt_rad", c.start_sigma_tilt_rad, 1e-4, 1.0},
       {"start_sigma_accel_matrix", c.start_sigma_accel_matrix, 0.0, 0.1},
       {"start_sigma_gyro_matrix", c.start_sigma_gyro_matrix, 0.0, 0.1},
       {"start_sigma_gyro_delay_s", c.start_sigma_gyro_delay_s, 0.0, 0.05},
       {"rest_s", c.rest_s, 0.02, 10.0},
       {"lost_nis", c.lost_nis, 1.0, 1e6},
       {"lost_first_nis", c.lost_first_nis, 1.0, 1e6},
       {"lost_relative_sigma", c.lost_relative_sigma, 0.01, 10.0},
       {"lost_range_m", c.lost_range_m, 0.1, 10.0}});
}

}  // namespace limbcast::filters
