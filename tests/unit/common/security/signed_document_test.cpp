#include "common/security/signed_document.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/common/security/security_examples.hpp"

namespace limbcast::security {
namespace {

using ::testing::HasSubstr;
using testing::kToday;

class SignedDocumentTest : public ::testing::Test {
 protected:
  SignedDocumentTest() {
    const auto document = Sign(*authority_, kText);
    EXPECT_TRUE(document.ok());
    document_ = *document;
  }
  static constexpr const char* kText = "<dds>\n<a>1</a>\n</dds>\n";
  const Result<Identity> authority_ = MakeAuthority("test-ca", kToday);
  std::string document_;
};

// S/MIME has lines that end in CR LF.
std::string WithoutCarriageReturns(std::string text) {
  std::erase(text, '\r');
  return text;
}

TEST_F(SignedDocumentTest, IsReadBackByWhoKnowsTheAuthority) {
  const auto text = ReadSigned(document_, *authority_->certificate);
  ASSERT_TRUE(text.ok()) << text.error().message;
  EXPECT_EQ(WithoutCarriageReturns(*text), kText);
}

TEST_F(SignedDocumentTest, IsTheTextThatBothLibrariesExpect) {
  EXPECT_THAT(document_, HasSubstr("multipart/signed"));
  EXPECT_THAT(document_, HasSubstr("Content-Type: text/plain"));
  EXPECT_THAT(document_, HasSubstr("<a>1</a>"));
}

TEST_F(SignedDocumentTest, AChangedDocumentIsRefused) {
  std::string changed = document_;
  changed.replace(changed.find("<a>1</a>"), 8, "<a>2</a>");
  const auto text = ReadSigned(changed, *authority_->certificate);
  ASSERT_FALSE(text.ok());
  EXPECT_EQ(text.error().code, ErrorCode::kCorruptData);
}

TEST_F(SignedDocumentTest, AnotherAuthorityOfTheSameNameIsRefused) {
  const auto other = MakeAuthority("test-ca", kToday);
  const auto text = ReadSigned(document_, *other->certificate);
  ASSERT_FALSE(text.ok());
  EXPECT_THAT(text.error().message, HasSubstr("another authority"));
}

TEST_F(SignedDocumentTest, AnythingElseIsNoDocument) {
  for (std::size_t length = 0; length < document_.size(); length += 97) {
    const auto text = ReadSigned(document_.substr(0, length), *authority_->certificate);
    ASSERT_FALSE(text.ok()) << length;
    EXPECT_EQ(text.error().code, ErrorCode::kCorruptData) << length;
  }
}

}  // namespace
}  // namespace limbcast::security
