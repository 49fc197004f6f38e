#include "common/filters/position/optical_inertial_config.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace limbcast::filters {
namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

Result<OpticalInertialConfig> From(const Settings& settings) {
  return ConfigFromSettings<OpticalInertialConfig>("optical_inertial", OpticalInertialFields(),
                                                   settings);
}

TEST(OpticalInertialConfigTest, DefaultsAreValid) {
  EXPECT_TRUE(Validate(OpticalInertialConfig{}).ok());
}

TEST(OpticalInertialConfigTest, SettingsChangeFieldsByName) {
  const auto config = From({{"lag_s", "0.8"}, {"estimate_calibration", "false"}});
  ASSERT_TRUE(config.ok());
  EXPECT_EQ(config->lag_s, 0.8);
  EXPECT_FALSE(config->estimate_calibration);
}

TEST(OpticalInertialConfigTest, RefusalsNameTheFieldAndItsRange) {
  const auto out = From({{"sigma_marker_m", "0"}});
  ASSERT_FALSE(out.ok());
  EXPECT_EQ(out.error().message, "optical_inertial.sigma_marker_m must be in (0, 0.1], is 0");
  const auto unknown = From({{"sigma_marker_mm", "1"}});
  ASSERT_FALSE(unknown.ok());
  EXPECT_NE(unknown.error().message.find("sigma_marker_m"), std::string::npos);
}

}  // namespace
}  // namespace limbcast::filters
