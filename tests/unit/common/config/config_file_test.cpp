#include "common/config/config_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <string>

namespace limbcast::config {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

ConfigFile ParseOk(std::string_view text) {
  Result<ConfigFile> file = ConfigFile::Parse(text, "test.toml");
  EXPECT_TRUE(file.ok()) << (file.ok() ? "" : file.error().message);
  return file.ok() ? *file : ConfigFile();
}

std::string MessageOf(const Status& status) { return status.ok() ? "ok" : status.error().message; }

TEST(ConfigFileTest, GivesDefaultsForWhatTheFileDoesNotSay) {
  const ConfigFile file;
  const Section section = file.Get("fusion");
  EXPECT_EQ(section.Read("workers", 2, 1, 64), 2);
  EXPECT_EQ(section.Read("max_gap_s", 0.5, 0.0, 10.0), 0.5);
  EXPECT_TRUE(section.Read("enabled", true));
  EXPECT_EQ(section.Read("name", "tqt", 16), "tqt");
  EXPECT_THAT(section.Read("peers", std::vector<std::string>{"a"}), ElementsAre("a"));
  EXPECT_TRUE(section.GetAll("sensor").empty());
  EXPECT_TRUE(file.Finish().ok());
}

TEST(ConfigFileTest, ReadsEveryKindOfValue) {
  const ConfigFile file = ParseOk(R"(
[fusion]
workers = 3
max_gap_s = 2
enabled = false
name = "bmf"
peers = ["10.0.0.1", "10.0.0.2"]
offset_m = [1, 2.5, -3.0]
uid = 9223372036854775807
[[fusion.sensor]]
segment = "pelvis"
[[fusion.sensor]]
segment = "head"
)");
  const Section section = file.Get("fusion");
  EXPECT_EQ(section.Read("workers", std::size_t{1}, 1, 64), 3U);
  EXPECT_EQ(section.Read("max_gap_s", 0.5, 0.0, 10.0), 2.0);
  EXPECT_FALSE(section.Read("enabled", true));
  EXPECT_EQ(section.Read("name", "tqt", 16), "bmf");
  EXPECT_THAT(section.Read("peers", std::vector<std::string>{}),
              ElementsAre("10.0.0.1", "10.0.0.2"));
  EXPECT_THAT(section.ReadNumbers("offset_m", {}, -10.0, 10.0, 3), ElementsAre(1.0, 2.5, -3.0));
  EXPECT_EQ(section.Read("uid", std::uint64_t{0}, 0, ~std::uint64_t{0}), 9223372036854775807U);
  const std::vector<Section> sensors = section.GetAll("sensor");
  ASSERT_EQ(sensors.size(), 2U);
  EXPECT_EQ(sensors[0].Read("segment", "", 32), "pelvis");
  EXPECT_EQ(sensors[1].Read("segment", "", 32), "head");
  EXPECT_EQ(sensors[1].path(), "fusion.sensor[1]");
  EXPECT_EQ(MessageOf(file.Finish()), "ok");
}

TEST(ConfigFileTest, AValueOutsideItsRangeIsNamedWithKeyLimitsAndLine) {
  const ConfigFile file = ParseOk("[fusion]\nworkers = 0\n");
  EXPECT_EQ(file.Get("fusion").Read("workers", 2, 1, 64), 2) << "the default stands in";
  EXPECT_EQ(MessageOf(file.Finish()), "test.toml:2: fusion.workers must be in [1, 64], is 0");
}

TEST(ConfigFileTest, OnlyTheFirstFailureIsTold) {
  const ConfigFile file = ParseOk("[a]\nx = 99\ny = 99.5\n");
  (void)file.Get("a").Read("x", 1, 0, 9);
  (void)file.Get("a").Read("y", 1.0, 0.0, 9.0);
  EXPECT_EQ(MessageOf(file.Finish()), "test.toml:2: a.x must be in [0, 9], is 99");
}

TEST(ConfigFileTest, TheWrongKindOfValueIsNamed) {
  const struct {
    const char* text;
    const char* message;
  } cases[] = {
      {"n = \"two\"", R"(test.toml:1: n must be a whole number in [1, 64], is "two")"},
      {"n = 1.5", "test.toml:1: n must be a whole number in [1, 64], is 1.5"},
      {"x = true", "test.toml:1: x must be a number in [0, 10], is true"},
      {"x = nan", "test.toml:1: x must be in [0, 10], is nan"},
      {"x = inf", "test.toml:1: x must be in [0, 10], is inf"},
      {"b = 1", "test.toml:1: b must be true or false, is 1"},
      {"s = 7", "test.toml:1: s must be a text in quotes, is 7"},
      {"s = \"12345\"", "test.toml:1: s must have at most 4 characters, has 5"},
      {"l = [1]", "test.toml:1: l must be a list of texts, is [ 1 ]"},
      {"v = [1.0, 2.0]", "test.toml:1: v must be a list of 3 numbers in [-1, 1], is [ 1.0, 2.0 ]"},
      {"t = 3", "test.toml:1: t must be a table, is 3"},
      {"tt = 3", "test.toml:1: tt must be a list of tables ([[tt]]), is 3"},
  };
  for (const auto& test : cases) {
    const ConfigFile file = ParseOk(test.text);
    const Section root = file.Root();
    (void)root.Read("n", 1, 1, 64);
    (void)root.Read("x", 1.0, 0.0, 10.0);
    (void)root.Read("b", false);
    (void)root.Read("s", "", 4);
    (void)root.Read("l", std::vector<std::string>{});
    (void)root.ReadNumbers("v", {}, -1.0, 1.0, 3);
    (void)root.Get("t");
    (void)root.GetAll("tt");
    EXPECT_EQ(MessageOf(file.Finish()), test.message);
  }
}

enum class Colour { kRed, kGreen };
constexpr std::array<std::pair<std::string_view, Colour>, 2> kColours = {
    {{"red", Colour::kRed}, {"green", Colour::kGreen}}};

TEST(ConfigFileTest, AChoiceOutsideTheAllowedOnesListsThem) {
  const std::span<const std::pair<std::string_view, Colour>> allowed(kColours);
  const ConfigFile good = ParseOk("colour = \"green\"");
  EXPECT_EQ(good.Root().Read("colour", Colour::kRed, allowed), Colour::kGreen);
  EXPECT_TRUE(good.Finish().ok());
  const ConfigFile bad = ParseOk("colour = \"blue\"");
  EXPECT_EQ(bad.Root().Read("colour", Colour::kRed, allowed), Colour::kRed);
  EXPECT_EQ(MessageOf(bad.Finish()), R"(test.toml:1: colour must be one of red, green, is "blue")");
}

TEST(ConfigFileTest, AKeyThatNobodyAsksForIsNamedWithItsLine) {
  const ConfigFile file = ParseOk("[fusion]\nworkers = 1\n\n[fusion.filter]\nnmae = \"tqt\"\n");
  const Section fusion = file.Get("fusion");
  (void)fusion.Read("workers", 1, 1, 64);
  (void)fusion.Get("filter").Read("name", "", 16);
  EXPECT_EQ(MessageOf(file.Finish()), "test.toml:5: fusion.filter.nmae is not a known key");
}

TEST(ConfigFileTest, AnUnknownTableAndAKeyInAListOfTablesAreFoundToo) {
  const ConfigFile table = ParseOk("[fussion]\nworkers = 1\n");
  (void)table.Get("fusion");
  EXPECT_EQ(MessageOf(table.Finish()), "test.toml:1: fussion is not a known key");
  const ConfigFile list = ParseOk("[[sensor]]\nid = 1\n[[sensor]]\nidd = 2\n");
  for (const Section& sensor : list.Root().GetAll("sensor")) {
    (void)sensor.Read("id", 0, 0, 9);
  }
  EXPECT_EQ(MessageOf(list.Finish()), "test.toml:4: sensor.idd is not a known key");
}

TEST(ConfigFileTest, SettingsThatNobodyKnowsByNameAreReadAsText) {
  const ConfigFile file = ParseOk("a = 0.3\nb = true\nc = \"quest\"\nd = 4\n");
  std::vector<std::string> texts;
  for (const std::string& key : file.Root().Keys()) {
    texts.push_back(file.Root().ReadAnyAsText(key));
  }
  EXPECT_THAT(texts, ElementsAre("0.3", "true", "quest", "4"));
  EXPECT_TRUE(file.Finish().ok());
}

TEST(ConfigFileTest, AFailureThatTheCallerFindsGetsItsPlace) {
  const ConfigFile file = ParseOk("\nname = \"x\"\n");
  (void)file.Root().Read("name", "", 16);
  file.Root().Fail("name", "must be one of tqt, is \"x\"");
  EXPECT_EQ(MessageOf(file.Finish()), R"(test.toml:2: name must be one of tqt, is "x")");
}

TEST(ConfigFileTest, AnOverrideGoesOverTheFileAndABareWordIsText) {
  ConfigFile file = ParseOk("[fusion]\nworkers = 1\n");
  EXPECT_TRUE(file.Override("fusion.workers=8").ok());
  EXPECT_TRUE(file.Override("fusion.name=tqt").ok());
  EXPECT_EQ(file.Get("fusion").Read("workers", 2, 1, 64), 8);
  EXPECT_EQ(file.Get("fusion").Read("name", "", 16), "tqt");
  EXPECT_TRUE(file.Finish().ok());
  EXPECT_THAT(MessageOf(file.Override("workers")), HasSubstr("--set must be KEY=VALUE"));
  EXPECT_FALSE(file.Override("a b=\"").ok());
}

TEST(ConfigFileTest, ARefusalOfAnOverrideNamesTheOptionAndNotTheFile) {
  ConfigFile file = ParseOk("[fusion]\nworkers = 1\n");
  EXPECT_TRUE(file.Override("fusion.workers=0").ok());
  (void)file.Get("fusion").Read("workers", 1, 1, 64);
  EXPECT_EQ(MessageOf(file.Finish()),
            "--set fusion.workers=0: fusion.workers must be in [1, 64], is 0");
  ConfigFile unknown = ParseOk("");
  EXPECT_TRUE(unknown.Override("fusionn.workers=2").ok());
  EXPECT_EQ(MessageOf(unknown.Finish()), "--set fusionn.workers=2: fusionn is not a known key");
}

TEST(ConfigFileTest, AMessageThatNamesItsKeyIsNotNamedTwice) {
  const ConfigFile file = ParseOk("[bus]\ndds = \"x\"\n");
  file.Get("bus").Fail("dds", "bus.dds must be one of cyclone, fast, is \"x\"");
  EXPECT_EQ(MessageOf(file.Finish()),
            R"(test.toml:2: bus.dds must be one of cyclone, fast, is "x")");
}

TEST(ConfigFileTest, AControlCharacterIsRefusedWithItsLine) {
  using std::string_literals::operator""s;
  for (const std::string& text : {"a = 1\n[\x10us]\n"s, "a = 1\n\0 = 2\n"s, "a = 1\n# \x7F\n"s}) {
    const Result<ConfigFile> file = ConfigFile::Parse(text, "bad.toml");
    ASSERT_FALSE(file.ok());
    EXPECT_THAT(file.error().message, ::testing::StartsWith("bad.toml:2: control character 0x"));
    EXPECT_THAT(file.error().message, ::testing::EndsWith(", TOML allows none"));
  }
  EXPECT_TRUE(ConfigFile::Parse("a = 1\r\n\tb = 2\n", "good.toml").ok());
}

TEST(ConfigFileTest, ASyntaxErrorIsNamedWithFileAndLine) {
  const Result<ConfigFile> file = ConfigFile::Parse("a = 1\nb = = 2\n", "bad.toml");
  ASSERT_FALSE(file.ok());
  EXPECT_EQ(file.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(file.error().message, HasSubstr("bad.toml:2: "));
  EXPECT_EQ(file.error().message.find('\n'), std::string::npos);
}

TEST(ConfigFileTest, AFileIsLoadedAndAMissingOneIsNamed) {
  const std::filesystem::path path =
      std::filesystem::path(::testing::TempDir()) / "limbcast_config_file_test.toml";
  std::ofstream(path) << "answer = 42\n";
  const Result<ConfigFile> file = ConfigFile::Load(path);
  ASSERT_TRUE(file.ok());
  EXPECT_EQ(file->Root().Read("answer", 0, 0, 100), 42);
  std::filesystem::remove(path);

  const Result<ConfigFile> missing = ConfigFile::Load(path);
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().code, ErrorCode::kNotFound);
  EXPECT_THAT(missing.error().message, HasSubstr(path.string()));
  EXPECT_FALSE(ConfigFile::Load(::testing::TempDir()).ok()) << "a folder is not a file";
}

}  // namespace
}  // namespace limbcast::config
