#include "common/config/named_values.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

namespace limbcast::config {
namespace {

using Numbers = std::vector<int>;

std::optional<int> Number(const std::string& name) {
  if (name == "one") {
    return 1;
  }
  return name == "two" ? std::optional<int>(2) : std::nullopt;
}

TEST(NamedValuesTest, NamesBecomeWhatTheyStandFor) {
  const auto file = ConfigFile::Parse("[a]\nlist = [\"two\", \"one\"]\n", "t.toml");
  ASSERT_TRUE(file.ok());
  EXPECT_EQ(ReadNamedList(file->Get("a"), "list", Numbers{}, Number, "numbers"), (Numbers{2, 1}));
  EXPECT_TRUE(file->Finish().ok());
}

TEST(NamedValuesTest, WithoutTheKeyItIsTheFallback) {
  const auto file = ConfigFile::Parse("[a]\nempty = []\n", "t.toml");
  ASSERT_TRUE(file.ok());
  EXPECT_EQ(ReadNamedList(file->Get("a"), "list", Numbers{1}, Number, "numbers"), Numbers{1});
  EXPECT_EQ(ReadNamedList(file->Get("a"), "empty", Numbers{1}, Number, "numbers"), Numbers{});
}

TEST(NamedValuesTest, OneName) {
  const auto file = ConfigFile::Parse("[a]\nx = \"two\"\ny = \"\"\n", "t.toml");
  ASSERT_TRUE(file.ok());
  const Section section = file->Get("a");
  EXPECT_EQ(ReadNamed(section, "x", 7, Number, "a number"), 2);
  EXPECT_EQ(ReadNamed(section, "z", 7, Number, "a number"), 7);
  EXPECT_EQ(ReadNamedIfAny(section, "x", std::optional<int>(), Number, "a number"), 2);
  EXPECT_EQ(ReadNamedIfAny(section, "y", std::optional<int>(7), Number, "a number"), 7);
  EXPECT_EQ(ReadNamedIfAny(section, "z", std::optional<int>(), Number, "a number"), std::nullopt);
  EXPECT_TRUE(file->Finish().ok());
}

TEST(NamedValuesTest, OneUnknownNameIsRefusedWithItsPlace) {
  for (const std::string name : {"ten", ""}) {
    const auto file = ConfigFile::Parse("[a]\nx = \"" + name + "\"\n", "t.toml");
    ASSERT_TRUE(file.ok());
    EXPECT_EQ(ReadNamed(file->Get("a"), "x", 7, Number, "a number"), 7);
    const Status finished = file->Finish();
    ASSERT_FALSE(finished.ok());
    EXPECT_EQ(finished.error().message, "t.toml:2: a.x must be a number, is '" + name + "'");
  }
}

TEST(NamedValuesTest, AnUnknownNameIsRefusedWithItsPlace) {
  const auto file = ConfigFile::Parse("[a]\nlist = [\"one\", \"ten\"]\n", "t.toml");
  ASSERT_TRUE(file.ok());
  EXPECT_EQ(ReadNamedList(file->Get("a"), "list", Numbers{}, Number, "numbers"), Numbers{1});
  const Status finished = file->Finish();
  ASSERT_FALSE(finished.ok());
  EXPECT_EQ(finished.error().message, "t.toml:2: a.list must be numbers, has 'ten'");
}

}  // namespace
}  // namespace limbcast::config
