#include "services/fusion/fusion_config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/service/service_command_line.hpp"

namespace limbcast::fusion {
namespace {

using ::testing::HasSubstr;

FusionConfig ReadText(std::string_view text, std::string* message) {
  const auto file = config::ConfigFile::Parse(text, "t.toml");
  EXPECT_TRUE(file.ok());
  const FusionConfig config = ReadFusionConfig(*file);
  const Status read = file->Finish();
  *message = read.ok() ? "" : read.error().message;
  return config;
}

TEST(FusionConfigTest, DefaultsAreValid) {
  const FusionConfig config;
  EXPECT_TRUE(Validate(config, MakeFilterFactory(config)).ok());
  EXPECT_EQ(config.filter.name, "bmf");
}

TEST(FusionConfigTest, ReadsFiltersBySegmentAndTheirSettings) {
  std::string message;
  const FusionConfig config = ReadText(R"(
[fusion]
workers = 3
[filter]
beside = "tqt"
[filter.segment.right_hand]
beside = ""
[filter.settings.tqt]
rho = 0.3
)",
                                       &message);
  EXPECT_EQ(message, "");
  EXPECT_EQ(config.workers, 3U);
  EXPECT_EQ(config.filter, (FilterChoice{"bmf", "tqt"}));
  EXPECT_EQ(config.segment_filters.at(body::Segment::kRightHand), (FilterChoice{"bmf", ""}));
  EXPECT_EQ(config.filter_settings.at("tqt"), (std::vector<filters::Setting>{{"rho", "0.3"}}));
  EXPECT_TRUE(Validate(config, MakeFilterFactory(config)).ok());
}

TEST(FusionConfigTest, SettingsOfFiltersHaveANumberOfTheirOwn) {
  FusionConfig config;
  const std::uint64_t none = FilterSettingsNumber(config);
  config.filter_settings["bmf"] = {{"slow_rate_hz", "10"}};
  const std::uint64_t one = FilterSettingsNumber(config);
  config.filter_settings["bmf"] = {{"slow_rate_hz", "11"}};
  const std::uint64_t other = FilterSettingsNumber(config);
  config.workers = 5;
  EXPECT_NE(none, one);
  EXPECT_NE(one, other);
  EXPECT_EQ(other, FilterSettingsNumber(config)) << "workers are none of theirs";
}

TEST(FusionConfigTest, RefusalsNameThePlaceTheValueAndTheLimit) {
  std::string message;
  (void)ReadText("[fusion]\nworkers = 65\n", &message);
  EXPECT_EQ(message, "t.toml:2: fusion.workers must be in [1, 64], is 65");
  (void)ReadText("[filter.segment.nose]\nname = \"tqt\"\n", &message);
  EXPECT_THAT(message, HasSubstr("t.toml:1: filter.segment.nose is not a segment"));
  (void)ReadText("[filter.settings.tqt]\nrho = 99\n", &message);
  EXPECT_THAT(message, HasSubstr("rho must be in [0, 10], is 99"));
  (void)ReadText("[filter]\nnmae = \"tqt\"\n", &message);
  EXPECT_EQ(message, "t.toml:2: filter.nmae is not a known key");
}

TEST(FusionConfigTest, ValidateRefusesFiltersThatNobodyMakesAndValuesOutsideTheirRange) {
  FusionConfig config;
  const FilterFactory factory = MakeFilterFactory(config);
  config.filter.name = "nonesuch";
  EXPECT_THAT(Validate(config, factory).error().message, HasSubstr("filter.name: "));
  config = {};
  config.segment_filters[body::Segment::kHead] = {.name = "tqt", .beside = "nonesuch"};
  EXPECT_THAT(Validate(config, factory).error().message, HasSubstr("filter.segment.head.beside: "));
  config = {};
  config.workers = 0;
  EXPECT_EQ(Validate(config, factory).error().message, "fusion.workers must be in [1, 64], is 0");
  config = {};
  config.queue_capacity = 1;
  EXPECT_FALSE(Validate(config, factory).ok());
  config = {};
  config.max_future_s = 0.0;
  EXPECT_FALSE(Validate(config, factory).ok());
  config = {};
  config.declination_deg = 181.0;
  EXPECT_EQ(Validate(config, factory).error().message,
            "fusion.declination_deg must be in [-180, 180], is 181");
  config = {};
  config.state_period_s = 0.0;
  EXPECT_EQ(Validate(config, factory).error().message,
            "fusion.state_period_s must be in [0.1, 3600], is 0");
  config = {};
  config.state_max_age_s = -1.0;
  EXPECT_EQ(Validate(config, factory).error().message,
            "fusion.state_max_age_s must be in [0, 1e7], is -1");
}

TEST(FusionConfigTest, TheFileThatIsDeployedSaysTheDefaults) {
  const auto file = config::ConfigFile::Load(LIMBCAST_SOURCE_DIR "/deploy/config/fusion.toml");
  ASSERT_TRUE(file.ok()) << file.error().message;
  const FusionConfig config = ReadFusionConfig(*file);
  const bus::BusConfig bus_config = service::ReadBusConfig(file->Get("bus"));
  const Status read = file->Finish();
  EXPECT_TRUE(read.ok()) << (read.ok() ? "" : read.error().message);
  EXPECT_EQ(bus_config.domain_id, bus::BusConfig{}.domain_id);
  EXPECT_EQ(bus_config.stream_depth, bus::BusConfig{}.stream_depth);
  const FusionConfig defaults;
  EXPECT_EQ(config.workers, defaults.workers);
  EXPECT_EQ(config.queue_capacity, defaults.queue_capacity);
  EXPECT_EQ(config.max_future_s, defaults.max_future_s);
  EXPECT_EQ(config.declination_deg, defaults.declination_deg);
  EXPECT_EQ(config.state_dir, defaults.state_dir);
  EXPECT_EQ(config.state_period_s, defaults.state_period_s);
  EXPECT_EQ(config.state_max_age_s, defaults.state_max_age_s);
  EXPECT_EQ(config.filter, defaults.filter);
  EXPECT_TRUE(config.segment_filters.empty());
}

}  // namespace
}  // namespace limbcast::fusion
