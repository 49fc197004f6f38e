#include "common/config/toml_text.hpp"

#include <gtest/gtest.h>

namespace limbcast::config {
namespace {

TEST(TomlTextTest, WhatIsQuotedIsReadBack) {
  const std::string text = R"(a "quoted" \ name)";
  const auto file = ConfigFile::Parse("name = " + Quoted(text), "x.toml");
  ASSERT_TRUE(file.ok());
  EXPECT_EQ(file->Root().Read("name", "", 64), text);
  EXPECT_EQ(Quoted("two\nlines"), "\"two?lines\"");
}

TEST(TomlTextTest, ReadsSixteenHexadecimalDigitsAndNothingElse) {
  const auto good = ConfigFile::Parse("uid = \"fedcba9876543210\"", "x.toml");
  EXPECT_EQ(ReadHex64(good->Root(), "uid"), 0xfedcba9876543210U);
  EXPECT_TRUE(good->Finish().ok());
  for (const std::string text : {"a1", "00000000000000g1", ""}) {
    const auto bad = ConfigFile::Parse("\nuid = \"" + text + "\"", "x.toml");
    (void)ReadHex64(bad->Root(), "uid");
    EXPECT_EQ(bad->Finish().error().message,
              "x.toml:2: uid must be 16 hexadecimal digits, is \"" + text + "\"");
  }
}

}  // namespace
}  // namespace limbcast::config
