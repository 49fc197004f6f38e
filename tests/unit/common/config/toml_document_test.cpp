#include "common/config/toml_document.hpp"

#include <gtest/gtest.h>

namespace limbcast::config::internal {
namespace {

TEST(TomlDocumentTest, MergeReplacesValuesAndKeepsTheRestOfATable) {
  toml::table into = *ParseToml("a = 1\n[t]\nx = 1\ny = 2\n[t.u]\nz = 3\n", "into");
  toml::table from = *ParseToml("a = 5\nb = 6\n[t]\nx = 7\n[t.u]\nw = 8\n", "from");
  Merge(into, from);
  EXPECT_EQ(into["a"].value_or(0), 5);
  EXPECT_EQ(into["b"].value_or(0), 6);
  EXPECT_EQ(into["t"]["x"].value_or(0), 7);
  EXPECT_EQ(into["t"]["y"].value_or(0), 2);
  EXPECT_EQ(into["t"]["u"]["z"].value_or(0), 3);
  EXPECT_EQ(into["t"]["u"]["w"].value_or(0), 8);
}

TEST(TomlDocumentTest, TextIsOneLineAsAPersonWouldWriteIt) {
  toml::table table = *ParseToml("s = \"x\"\nn = 1.5\nb = true\nl = [1, 2]\n", "t");
  EXPECT_EQ(TextOf(*table.get("s")), "\"x\"");
  EXPECT_EQ(TextOf(*table.get("n")), "1.5");
  EXPECT_EQ(TextOf(*table.get("b")), "true");
  EXPECT_EQ(TextOf(*table.get("l")), "[ 1, 2 ]");
}

TEST(TomlDocumentTest, TheFirstUnknownKeyInTheOrderOfTheFileIsFound) {
  Document document;
  document.name = "t.toml";
  document.root = *ParseToml("zeta = 1\nalpha = 2\n", "t.toml");
  const auto error = FindUnknown(document, document.root, "");
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->message, "t.toml:1: zeta is not a known key");
  document.known = {document.root.get("zeta"), document.root.get("alpha")};
  EXPECT_FALSE(FindUnknown(document, document.root, "").has_value());
}

TEST(TomlDocumentTest, APlaceIsTheFileAndLineOrTheOption) {
  Document document;
  document.name = "t.toml";
  document.root = *ParseToml("\na = 1\n", "t.toml");
  EXPECT_EQ(PlaceOf(document, document.root.get("a")), "t.toml:2");
  EXPECT_EQ(PlaceOf(document, nullptr), "t.toml");
  toml::table option = *ParseToml("b = 1", "--set b=1");
  EXPECT_EQ(PlaceOf(document, option.get("b")), "--set b=1");
}

TEST(TomlDocumentTest, WhatIsNotTomlIsRefusedWithItsLine) {
  const auto parsed = ParseToml("a = 1\n\n!\n", "t.toml");
  ASSERT_FALSE(parsed.ok());
  EXPECT_EQ(parsed.error().message.substr(0, 10), "t.toml:3: ");
}

}  // namespace
}  // namespace limbcast::config::internal
