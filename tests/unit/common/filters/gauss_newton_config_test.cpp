#include "common/filters/gauss_newton_config.hpp"

#include <gtest/gtest.h>

namespace limbcast::filters {
namespace {

TEST(GaussNewtonConfigTest, TheDefaultsAreValid) {
  EXPECT_TRUE(Validate(GaussNewtonConfig()).ok());
}

TEST(GaussNewtonConfigTest, ARefusalNamesTheFieldAndTheRange) {
  GaussNewtonConfig config;
  config.rho = 11.0;
  const Status status = Validate(config);
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().message, "tqt.rho must be in [0, 10], is 11");
}

TEST(GaussNewtonConfigTest, EveryFieldCounts) {
  for (const auto& field : GaussNewtonFields()) {
    GaussNewtonConfig config;
    field.set(config, field.max + 1.0);
    EXPECT_FALSE(Validate(config).ok()) << field.name;
  }
}

}  // namespace
}  // namespace limbcast::filters
