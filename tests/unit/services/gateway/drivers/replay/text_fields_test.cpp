#include "services/gateway/drivers/replay/text_fields.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace limbcast::gateway {
namespace {

using ::testing::ElementsAre;

TEST(TextFieldsTest, LinesEndWithEitherLineEnd) {
  LineReader lines("a\r\n\nb");
  EXPECT_EQ(lines.Next(), "a");
  EXPECT_EQ(lines.Next(), "");
  EXPECT_EQ(lines.Next(), "b");
  EXPECT_EQ(lines.number(), 3U);
  EXPECT_EQ(lines.Next(), std::nullopt);
}

TEST(TextFieldsTest, FieldsAreTrimmedAndEmptyOnesKept) {
  std::vector<std::string_view> fields;
  SplitFields(" a ,,b c,", ',', fields);
  EXPECT_THAT(fields, ElementsAre("a", "", "b c", ""));
}

TEST(TextFieldsTest, NumbersAreWholeFields) {
  EXPECT_EQ(ParseNumber("-1.5e-3"), -1.5e-3);
  EXPECT_EQ(ParseNumber("+2"), 2.0);
  EXPECT_EQ(ParseNumber("00472"), 472.0);
  EXPECT_TRUE(std::isnan(*ParseNumber("nan")));
  EXPECT_TRUE(std::isinf(*ParseNumber("-inf")));
  EXPECT_EQ(ParseNumber(""), std::nullopt);
  EXPECT_EQ(ParseNumber("1.0 m"), std::nullopt);
  EXPECT_EQ(ParseNumber("1,0"), std::nullopt);
}

TEST(TextFieldsTest, MissingFileIsNotFound) {
  EXPECT_EQ(ReadWholeFile("/nowhere/at/all").error().code, ErrorCode::kNotFound);
}

}  // namespace
}  // namespace limbcast::gateway
