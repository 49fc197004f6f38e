#include "services/fusion/position_config.hpp"

#include <gtest/gtest.h>

#include "services/fusion/fusion_config.hpp"

namespace limbcast::fusion {
namespace {

PositionConfig Read(const std::string& text, Status* finished) {
  const auto file = config::ConfigFile::Parse(text, "fusion.toml");
  EXPECT_TRUE(file);
  const PositionConfig config = ReadFusionConfig(*file).position;
  *finished = file->Finish();
  return config;
}

std::string Refusal(const std::string& text) {
  Status finished = Ok();
  const PositionConfig config = Read(text, &finished);
  if (finished) {
    finished = Validate(config);
  }
  return finished ? "" : finished.error().message;
}

TEST(PositionConfigTest, WithoutSettingsNothingHasAPosition) {
  Status finished = Ok();
  const PositionConfig config = Read("", &finished);
  EXPECT_TRUE(finished);
  EXPECT_TRUE(Validate(config));
  EXPECT_FALSE(config.coils.source);
  EXPECT_TRUE(config.markers.segments.empty());
}

TEST(PositionConfigTest, ReadsBothTables) {
  Status finished = Ok();
  const PositionConfig config = Read(
      "[fusion]\nposition_lag_s = 0.5\n[fusion.coils]\nsource = \"pelvis\"\nsensors = "
      "[\"left_hand\"]\nsigma_mag_nt = 50\n"
      "[fusion.markers]\nsegments = [\"pelvis\", \"t8\"]\nlever_arm_m = [0, 0.01, 0]\n",
      &finished);
  EXPECT_TRUE(finished) << finished.error().message;
  EXPECT_TRUE(Validate(config));
  EXPECT_EQ(config.lag_s, 0.5);
  EXPECT_EQ(config.coils.source, body::Segment::kPelvis);
  EXPECT_EQ(config.coils.sensors, std::vector{body::Segment::kLeftHand});
  EXPECT_DOUBLE_EQ(config.coils.filter.sigma_mag_tesla, 50e-9);
  EXPECT_EQ(config.markers.segments.size(), 2U);
  EXPECT_DOUBLE_EQ(config.markers.filter.lever_arm_y_m, 0.01);
}

TEST(PositionConfigTest, RefusalsNameThingValueAndLimit) {
  EXPECT_NE(Refusal("[fusion.coils]\nsource = \"belt\"\n").find("is 'belt'"), std::string::npos);
  EXPECT_NE(Refusal("[fusion.coils]\ncurrent_a = 50\n").find("current_a must be in [0.01, 20]"),
            std::string::npos);
  EXPECT_NE(Refusal("[fusion.coils]\nsource = \"pelvis\"\nsensors = [\"pelvis\"]\n")
                .find("fusion.coils.sensors has pelvis, which carries the source"),
            std::string::npos);
  EXPECT_NE(
      Refusal("[fusion]\nposition_lag_s = 3\n").find("position_lag_s must be in [0, 2], is 3"),
      std::string::npos);
  EXPECT_NE(Refusal("[fusion.markers]\nsegments = [\"t8\", \"t8\"]\n")
                .find("fusion.markers.segments names t8 twice"),
            std::string::npos);
}

}  // namespace
}  // namespace limbcast::fusion
