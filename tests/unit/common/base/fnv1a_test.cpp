#include "common/base/fnv1a.hpp"

#include <gtest/gtest.h>

#include <string_view>

namespace limbcast {
namespace {

TEST(Fnv1aTest, PublishedValues) {
  EXPECT_EQ(Fnv1a(kFnv1aBasis, ""), 0xcbf29ce484222325U);
  EXPECT_EQ(Fnv1a(kFnv1aBasis, "a"), 0xaf63dc4c8601ec8cU);
  EXPECT_EQ(Fnv1a(kFnv1aBasis, "foobar"), 0x85944171f73967e8U);
}

TEST(Fnv1aTest, BytesTextAndPartsAreTheSame) {
  constexpr std::string_view kText = "foobar";
  EXPECT_EQ(Fnv1a(kFnv1aBasis, std::as_bytes(std::span(kText))), Fnv1a(kFnv1aBasis, kText));
  EXPECT_EQ(Fnv1a(Fnv1a(kFnv1aBasis, "foo"), "bar"), Fnv1a(kFnv1aBasis, kText));
  EXPECT_EQ(Fnv1a(Fnv1a(kFnv1aBasis, "fooba"), std::uint8_t{'r'}), Fnv1a(kFnv1aBasis, kText));
}

}  // namespace
}  // namespace limbcast
