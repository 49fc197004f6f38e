#include "services/session/session_names.hpp"

#include <gtest/gtest.h>

#include <string>

namespace limbcast::session {
namespace {

TEST(SessionNamesTest, ASessionIsNamedByWhatIsNoPattern) {
  EXPECT_TRUE(ValidateSessionName("stage_2.A-b").ok());
  EXPECT_TRUE(ValidateSessionName(std::string(64, 's')).ok());
  for (const char* bad : {"", "*", "a?", "a,b", "a b", "[a]", "/x", "a\n", "\xC3\xA9"}) {
    EXPECT_FALSE(ValidateSessionName(bad).ok()) << bad;
  }
  EXPECT_FALSE(ValidateSessionName(std::string(65, 's')).ok());
}

TEST(SessionNamesTest, APersonIsNamedInAnyScript) {
  for (const char* good : {"Ada Lovelace", "\"quoted\" \\", "Zo\xC3\xAB", "\xE6\x9D\x8E",
                           "\xF0\x9F\x95\xBA", "\xED\x9F\xBF", "\xF4\x8F\xBF\xBF"}) {
    EXPECT_TRUE(ValidatePersonName(good).ok()) << good;
  }
  EXPECT_TRUE(ValidatePersonName(std::string(64, 'p')).ok());
  EXPECT_FALSE(ValidatePersonName(std::string(65, 'p')).ok());
}

TEST(SessionNamesTest, WhatIsNoTextNamesNobody) {
  // Control characters; a lone continuation, cut off, overlong, a surrogate, above U+10FFFF.
  for (const char* bad : {"", "\n", "a\tb", "\x7F", "\xC2\x85", "\x80", "\xC3", "\xE6\x9D",
                          "\xC0\xAF", "\xE0\x80\xAF", "\xF0\x80\x80\xAF", "\xED\xA0\x80",
                          "\xF4\x90\x80\x80", "\xFF", "ok\xC3("}) {
    EXPECT_FALSE(ValidatePersonName(bad).ok()) << bad;
  }
}

}  // namespace
}  // namespace limbcast::session
