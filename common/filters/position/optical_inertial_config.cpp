#include "common/filters/position/optical_inertial_config.hpp"

#include <array>

namespace limbcast::filters {
namespace {

using C = OpticalInertialConfig;
constexpr std::array kFields = {
    Number<&C::block_s>("block_s", 0.001, 0.05),
    Number<&C::lag_s>("lag_s", 0.0, 5.0),
    Number<&C::sigma_accel_m_s2_rthz>("sigma_accel_m_s2_rthz", 0.0, 10.0, true),
    Number<&C::sigma_gyro_rad_s_rthz>("sigma_gyro_rad_s_rthz", 0.0, 1.0, true),
    Number<&C::walk_accel_bias_m_s3_rthz>("walk_accel_bias_m_s3_rthz", 0.0, 1.0),
    Number<&C::walk_gyro_bias_rad_s2_rthz>("walk_gyro_bias_rad_s2_rthz", 0.0, 1.0),
    Number<&C::tau_accel_bias_s>("tau_accel_bias_s", 0.0, 1e6),
    Number<&C::tau_gyro_bias_s>("tau_gyro_bias_s", 0.0, 1e6),
    Number<&C::k_accel>("k_accel", 0.0, 1.0),
    Number<&C::k_rate>("k_rate", 0.0, 1.0),
    Number<&C::k_accel_bend>("k_accel_bend", 0.0, 10.0),
    Number<&C::k_rate_bend>("k_rate_bend", 0.0, 10.0),
    Number<&C::sigma_marker_m>("sigma_marker_m", 0.0, 0.1, true),
    Number<&C::sigma_marker_time_s>("sigma_marker_time_s", 0.0, 0.1),
    Flag<&C::estimate_lever_arm>("estimate_lever_arm"),
    Flag<&C::estimate_gravity>("estimate_gravity"),
    Flag<&C::estimate_time_offset>("estimate_time_offset"),
    Flag<&C::estimate_calibration>("estimate_calibration"),
    Flag<&C::estimate_gyro_delay>("estimate_gyro_delay"),
    Number<&C::lever_arm_x_m>("lever_arm_x_m", -1.0, 1.0),
    Number<&C::lever_arm_y_m>("lever_arm_y_m", -1.0, 1.0),
    Number<&C::lever_arm_z_m>("lever_arm_z_m", -1.0, 1.0),
    Number<&C::marker_lead_s>("marker_lead_s", -0.1, 0.1),
    Number<&C::gyro_delay_s>("gyro_delay_s", -0.05, 0.05),
    Number<&C::gravity_m_s2>("gravity_m_s2", 9.0, 10.0),
    Number<&C::sigma_start_p_m>("sigma_start_p_m", 0.0, 10.0, true),
    Number<&C::sigma_start_v_m_s>("sigma_start_v_m_s", 0.0, 10.0, true),
    Number<&C::sigma_start_tilt_rad>("sigma_start_tilt_rad", 0.0, 1.0, true),
    Number<&C::sigma_start_heading_rad>("sigma_start_heading_rad", 0.0, 3.0, true),
    Number<&C::sigma_start_accel_bias_m_s2>("sigma_start_accel_bias_m_s2", 0.0, 10.0),
    Number<&C::sigma_start_gyro_bias_rad_s>("sigma_start_gyro_bias_rad_s", 0.0, 1.0),
    Number<&C::sigma_start_lever_m>("sigma_start_lever_m", 0.0, 1.0),
    Number<&C::sigma_start_gravity_tilt_rad>("sigma_start_gravity_tilt_rad", 0.0, 1.0),
    Number<&C::sigma_start_gravity_m_s2>("sigma_start_gravity_m_s2", 0.0, 1.0),
    Number<&C::sigma_start_marker_lead_s>("sigma_start_marker_lead_s", 0.0, 0.1),
    Number<&C::sigma_start_gyro_delay_s>("sigma_start_gyro_delay_s", 0.0, 0.05),
    Number<&C::sigma_start_accel_matrix>("sigma_start_accel_matrix", 0.0, 0.2),
    Number<&C::sigma_start_gyro_matrix>("sigma_start_gyro_matrix", 0.0, 0.2),
    Number<&C::accel_range_m_s2>("accel_range_m_s2", 0.0, 1e4),
    Number<&C::gyro_range_rad_s>("gyro_range_rad_s", 0.0, 1e4),
};

}  // namespace

std::span<const SettingField<OpticalInertialConfig>> OpticalInertialFields() { return kFields; }

Status Validate(const OpticalInertialConfig& config) {
  return ValidateFields<OpticalInertialConfig>("optical_inertial", config, kFields);
}

}  // namespace limbcast::filters
