#include "common/filters/position/coil_inertial_config.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace limbcast::filters {
namespace {

TEST(CoilInertialConfigTest, DefaultsAreValid) { EXPECT_TRUE(Validate(CoilInertialConfig{})); }

TEST(CoilInertialConfigTest, TheFirstRangeNotKeptIsNamed) {
  CoilInertialConfig config;
  config.sigma_mag_tesla = 0.0;
  config.iterations = 0;
  const Status status = Validate(config);
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().message.find("sigma_mag_tesla"), std::string::npos);
}

TEST(CoilInertialConfigTest, WhatIsOutOfRangeIsRefused) {
  CoilInertialConfig config;
  config.start_sigma_v_m_s = std::nan("");
  EXPECT_FALSE(Validate(config));
  config = {};
  config.start_sigma_gyro_matrix = 0.2;
  EXPECT_FALSE(Validate(config));
  config = {};
  config.half_space = Eigen::Vector3d(0.0, 0.0, 2.0);
  EXPECT_FALSE(Validate(config));
}

}  // namespace
}  // namespace limbcast::filters
