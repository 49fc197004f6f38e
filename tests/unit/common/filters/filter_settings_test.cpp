#include "common/filters/filter_settings.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace limbcast::filters {
namespace {

enum class Colour { kRed = 0, kBlue = 1 };
struct Config {
  double gain = 0.5;
  int count = 3;
  Colour colour = Colour::kRed;
  bool enabled = true;
  double bound = 1.0;
};
constexpr std::array<std::string_view, 2> kColours = {"red", "blue"};
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::array<SettingField<Config>, 5> kFields = {
    Number<&Config::gain>("gain", 0.0, 1.0), Whole<&Config::count>("count", 1.0, 9.0),
    Choice<&Config::colour>("colour", kColours), Flag<&Config::enabled>("enabled"),
    Number<&Config::bound>("bound", 0.0, kInfinity, true)};

using Settings = std::vector<std::pair<std::string, std::string>>;

Result<Config> From(const Settings& settings) {
  return ConfigFromSettings<Config>("f", kFields, settings);
}
std::string MessageOf(const Settings& settings) {
  const auto config = From(settings);
  return config.ok() ? "accepted" : config.error().message;
}

TEST(FilterSettingsTest, SetsEachKindByItsName) {
  const auto config = From({{"gain", "0.25"},
                            {"count", "7"},
                            {"colour", "blue"},
                            {"enabled", "false"},
                            {"bound", "inf"}});
  ASSERT_TRUE(config.ok());
  EXPECT_EQ(config->gain, 0.25);
  EXPECT_EQ(config->count, 7);
  EXPECT_EQ(config->colour, Colour::kBlue);
  EXPECT_FALSE(config->enabled);
  EXPECT_EQ(config->bound, kInfinity);
}

TEST(FilterSettingsTest, WithoutSettingsTheDefaultsStay) {
  const auto config = From({});
  ASSERT_TRUE(config.ok());
  EXPECT_EQ(config->count, 3);
}

TEST(FilterSettingsTest, MessagesNameThingValueAndLimit) {
  EXPECT_EQ(MessageOf({{"gian", "1"}}),
            "filter f has no setting 'gian', it has gain, count, colour, enabled, bound");
  EXPECT_EQ(MessageOf({{"gain", "2"}}), "f.gain must be in [0, 1], is 2");
  EXPECT_EQ(MessageOf({{"gain", "nan"}}), "f.gain must be in [0, 1], is nan");
  EXPECT_EQ(MessageOf({{"gain", "fast"}}), "f.gain must be in [0, 1], is 'fast'");
  EXPECT_EQ(MessageOf({{"gain", ""}}), "f.gain must be in [0, 1], is ''");
  EXPECT_EQ(MessageOf({{"count", "2.5"}}), "f.count must be a whole number in [1, 9], is '2.5'");
  EXPECT_EQ(MessageOf({{"count", "1e30"}}), "f.count must be a whole number in [1, 9], is '1e30'");
  EXPECT_EQ(MessageOf({{"colour", "green"}}), "f.colour must be red or blue, is 'green'");
  EXPECT_EQ(MessageOf({{"enabled", "yes"}}), "f.enabled must be false or true, is 'yes'");
  EXPECT_EQ(MessageOf({{"bound", "0"}}), "f.bound must be in (0, inf], is 0");
}

}  // namespace
}  // namespace limbcast::filters
