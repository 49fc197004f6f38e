#include "common/filters/bounded_motion_config.hpp"

#include <array>
#include <limits>

namespace limbcast::filters {
namespace {

using C = BoundedMotionConfig;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::array kFields = {
    Choice<&C::precision>("precision", kPrecisionNames),
    Number<&C::slow_rate_hz>("slow_rate_hz", 5.0, 100.0),
    Number<&C::init_time_s>("init_time_s", 0.0, 10.0),
    Number<&C::output_lead_s>("output_lead_s", -0.1, 0.1),
    Number<&C::sigma_gyro_rad_s_rthz>("sigma_gyro_rad_s_rthz", 0.0, 1.0, true),
    Number<&C::k_rate_rts>("k_rate_rts", 0.0, 1.0),
    Number<&C::walk_gyro_bias_rad_s_rts>("walk_gyro_bias_rad_s_rts", 0.0, 1.0),
    Number<&C::sigma_gyro_bias_start_rad_s>("sigma_gyro_bias_start_rad_s", 0.0, 1.0),
    Number<&C::walk_gyro_matrix_rts>("walk_gyro_matrix_rts", 0.0, 0.1),
    Number<&C::sigma_gyro_matrix_start>("sigma_gyro_matrix_start", 0.0, 0.1),
    Number<&C::sigma_accel_m_s2_rthz>("sigma_accel_m_s2_rthz", 0.0, 10.0, true),
    Number<&C::walk_accel_bias_m_s2_rts>("walk_accel_bias_m_s2_rts", 0.0, 10.0),
    Number<&C::sigma_accel_bias_start_m_s2>("sigma_accel_bias_start_m_s2", 0.0, 10.0),
    Number<&C::velocity_bound_m_s_rts>("velocity_bound_m_s_rts", 0.0, kInfinity, true),
    Number<&C::position_bound_m_rts>("position_bound_m_rts", 0.0, kInfinity, true),
    Number<&C::position_persistence_s>("position_persistence_s", 0.0, 100.0),
    Number<&C::sigma_mag_ref_rts>("sigma_mag_ref_rts", 0.0, 10.0, true),
    Flag<&C::mag_heading_only>("mag_heading_only"),
    Number<&C::k_deviation_rts>("k_deviation_rts", 0.0, 10.0),
    Number<&C::deviation_hold_s>("deviation_hold_s", 0.0, 10.0, true),
    Number<&C::scatter_time_s>("scatter_time_s", 0.0, 1000.0, true),
    Number<&C::scatter_floor_ref>("scatter_floor_ref", 0.0, kInfinity, true),
    Number<&C::walk_reference_ref_rts>("walk_reference_ref_rts", 0.0, 1.0),
    Number<&C::sigma_reference_start_ref>("sigma_reference_start_ref", 0.0, 1.0),
    Number<&C::reference_field_tesla>("reference_field_tesla", 0.0, 1e-3),
    Number<&C::reference_dip_rad>("reference_dip_rad", -1.57, 1.57),
    Number<&C::carried_jump_ref_rts>("carried_jump_ref_rts", 0.0, 100.0),
    Number<&C::carried_jump_threshold_ref>("carried_jump_threshold_ref", 0.0, 10.0, true),
    Number<&C::carried_jump_time_s>("carried_jump_time_s", 0.0, 10.0, true),
    Number<&C::walk_carried_field_ref_rts>("walk_carried_field_ref_rts", 0.0, 1.0),
    Number<&C::sigma_carried_field_start_ref>("sigma_carried_field_start_ref", 0.0, 1.0),
    Number<&C::gate_nis>("gate_nis", 3.0, 1e6),
    Number<&C::sigma_rest_rad_s_rts>("sigma_rest_rad_s_rts", 0.0, 1.0, true),
    Number<&C::rest_turn_persistence_s>("rest_turn_persistence_s", 0.0, 100.0),
    Number<&C::sigma_zero_velocity_m_s>("sigma_zero_velocity_m_s", 0.0, 1.0, true),
    Number<&C::sigma_tilt_start_rad>("sigma_tilt_start_rad", 0.0, 3.0, true),
    Number<&C::sigma_heading_start_rad>("sigma_heading_start_rad", 0.0, 3.0, true),
    Number<&C::sigma_time_s>("sigma_time_s", 0.0, 0.1),
};

}  // namespace

std::span<const SettingField<BoundedMotionConfig>> BoundedMotionFields() { return kFields; }

Status Validate(const BoundedMotionConfig& config) {
  return ValidateFields<BoundedMotionConfig>("bmf", config, kFields);
}

BoundedMotionConfig PlainBoundedMotionConfig() {
  BoundedMotionConfig config;
  config.sigma_gyro_matrix_start = 0.002;
  config.sigma_accel_m_s2_rthz = 0.01;
  config.position_persistence_s = 0.0;
  config.sigma_mag_ref_rts = 0.1;
  config.mag_heading_only = false;
  config.k_deviation_rts = 0.3;
  config.deviation_hold_s = 0.2;
  config.scatter_floor_ref = kInfinity;
  config.walk_reference_ref_rts = 0.0;
  config.sigma_reference_start_ref = 0.0;
  config.rest_turn_persistence_s = 0.0;
  config.sigma_time_s = 0.0;
  return config;
}

}  // namespace limbcast::filters
