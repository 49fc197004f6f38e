#include "common/base/utf8.hpp"

#include <gtest/gtest.h>

#include <string>

namespace limbcast {
namespace {

TEST(Utf8Test, CharactersOfOneToFourBytes) {
  std::string_view text = "a\u00e9\u20ac\U0001F9B4";
  EXPECT_EQ(TakeCharacter(text), U'a');
  EXPECT_EQ(TakeCharacter(text), U'\u00e9');
  EXPECT_EQ(TakeCharacter(text), U'\u20ac');
  EXPECT_EQ(TakeCharacter(text), U'\U0001F9B4');
  EXPECT_TRUE(text.empty());
  std::string_view last = "\xF4\x8F\xBF\xBF";
  EXPECT_EQ(TakeCharacter(last), U'\U0010FFFF');
}

TEST(Utf8Test, WhatIsNoCharacterStaysThere) {
  for (const std::string bytes : {"\x80", "\xC3", "\xC3(", "\xC0\xAF", "\xE0\x80\xAF",
                                  "\xED\xA0\x80", "\xF0\x80\x80\xAF", "\xF4\x90\x80\x80", "\xFF"}) {
    std::string_view text = bytes;
    EXPECT_EQ(TakeCharacter(text), std::nullopt);
    EXPECT_EQ(text, bytes);
  }
}

}  // namespace
}  // namespace limbcast
