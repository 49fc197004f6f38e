#include "common/config/toml_ascii.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "common/config/toml_document.hpp"

namespace limbcast::config::internal {
namespace {

bool IsAsciiText(const std::string& text) {
  return std::ranges::all_of(text, [](unsigned char c) { return c < 0x80; });
}

// What is read of `a` in the document `text`, whose next line says b = 1.
void ExpectValue(const std::string& text, const std::string& value) {
  const std::string whole = text + "\nb = 1\n";
  const auto ascii = AsciiToml(whole, "t.toml");
  ASSERT_TRUE(ascii.ok()) << whole;
  EXPECT_TRUE(IsAsciiText(*ascii)) << *ascii;
  const auto parsed = ParseToml(whole, "t.toml");
  ASSERT_TRUE(parsed.ok()) << whole << parsed.error().message;
  EXPECT_EQ((*parsed)["a"].value_or(std::string("none")), value) << whole;
  EXPECT_EQ((*parsed)["b"].value_or(0), 1) << whole;
  EXPECT_EQ(parsed->get("b")->source().begin.line, std::ranges::count(whole, '\n')) << whole;
}

TEST(TomlAsciiTest, StringsMeanWhatTheyMeant) {
  ExpectValue(
      "\xEF\xBB\xBF"
      "a = \"\u00fc\" # \u00e4 \"",
      "\u00fc");
  ExpectValue("a = 'C:\\\u0447\"'", "C:\\\u0447\"");
  ExpectValue("a = \"\\\"\u0447\\\\\" # \"", "\"\u0447\\");
  ExpectValue("a = \"\"\"\n\u0447 \"\" \u00e9\n\"\"\"", "\u0447 \"\" \u00e9\n");
  ExpectValue("a = \"\"\"\u0447\"\"\"\"\"", "\u0447\"\"");
  ExpectValue("a = \"\"\"x \\\n  \u00e9\"\"\"", "x \u00e9");
  ExpectValue("a = '''\n\u0447\\\n'x'''''", "\u0447\\\n'x''");
  ExpectValue("a = \"\U0001F9B4\u200b\"", "\U0001F9B4\u200b");
  ExpectValue("'\u0447' = \"\u0447\"\na = \"\"", "");
  ExpectValue("# \u0447 'x\na = 'x'", "x");
}

TEST(TomlAsciiTest, AsciiStaysAsItIs) {
  const std::string text = "a = 'x' # comment\nb = \"\\u00e9\"\n!";
  EXPECT_EQ(AsciiToml(text, "t.toml").value(), text);
  EXPECT_EQ(AsciiToml("", "t.toml").value(), "");
}

TEST(TomlAsciiTest, LettersOutsideOfQuotesAreNamedWithTheirLine) {
  for (const std::string text :
       {"x = 1\n\u0447\n", "x = 'a'\n\u0447 = 1\n", "x = 1 # \"\n\u0447 = 1\n",
        "x = \"\\\\\"\n[\u0447]\n", "x = '\\'\na = \u0447\n", "x = '''''\u0447'''''\n\u0447"}) {
    const auto parsed = ParseToml(text, "t.toml");
    ASSERT_FALSE(parsed.ok()) << text;
    EXPECT_EQ(parsed.error().message,
              "t.toml:2: '\u0447' outside of quotes, TOML allows ASCII only there");
  }
}

TEST(TomlAsciiTest, BytesThatAreNoUtf8AreNamedWithTheirLine) {
  const auto parsed = ParseToml("x = 1\na = \"\xC3(\"\n", "t.toml");
  ASSERT_FALSE(parsed.ok());
  EXPECT_EQ(parsed.error().message, "t.toml:2: byte 0xc3 is no UTF-8");
}

TEST(TomlAsciiTest, WhatIsWrongOtherwiseIsLeftToTheParser) {
  // Strings without end, a letter escaped, and what tests/fuzz found.
  for (const std::string text : {"a = \"\u0447", "a = \"\u0447\nb = 1", "a = '''\u0447''",
                                 "a = \"\\\u0447\"", "a = \"\u0447\\", "a =2222[[{\"0\u0124)\n"}) {
    const auto ascii = AsciiToml(text, "t.toml");
    ASSERT_TRUE(ascii.ok()) << text;
    EXPECT_TRUE(IsAsciiText(*ascii)) << *ascii;
    EXPECT_FALSE(ParseToml(text, "t.toml").ok()) << text;
  }
}

}  // namespace
}  // namespace limbcast::config::internal
