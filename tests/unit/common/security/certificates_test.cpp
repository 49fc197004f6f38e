#include "common/security/certificates.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/common/security/security_examples.hpp"

namespace limbcast::security {
namespace {

using ::testing::HasSubstr;
using testing::kToday;
using ::testing::MatchesRegex;

class CertificatesTest : public ::testing::Test {
 protected:
  const Result<Identity> authority_ = MakeAuthority("test-ca", kToday);
};

TEST_F(CertificatesTest, AnIdentityIsSignedByItsAuthorityOnly) {
  ASSERT_TRUE(authority_.ok());
  const auto identity = MakeIdentity(*authority_, "fusion", Library::kCyclone, kToday);
  const auto other = MakeAuthority("test-ca", kToday);
  ASSERT_TRUE(identity.ok() && other.ok());
  EXPECT_TRUE(IsSignedBy(*identity->certificate, *authority_->certificate));
  EXPECT_FALSE(IsSignedBy(*identity->certificate, *other->certificate)) << "the same name";
  EXPECT_TRUE(IsKeyOf(*identity->key, *identity->certificate));
  EXPECT_FALSE(IsKeyOf(*other->key, *identity->certificate));
}

TEST_F(CertificatesTest, SubjectsFitTheLibraryTheyAreForAndNotTheOther) {
  for (const auto library : {Library::kCyclone, Library::kFast}) {
    const auto other = library == Library::kFast ? Library::kCyclone : Library::kFast;
    for (const char* name : {"gateway", "fusion", "x"}) {
      const auto identity = MakeIdentity(*authority_, name, library, kToday);
      ASSERT_TRUE(identity.ok());
      EXPECT_TRUE(SubjectFits(*identity->certificate, library));
      EXPECT_FALSE(SubjectFits(*identity->certificate, other));
    }
  }
}

// The order of RFC 2253 is the one that Fast DDS compares, text for text.
TEST_F(CertificatesTest, SubjectsReadAsFastDdsReadsThem) {
  const auto identity = MakeIdentity(*authority_, "fusion-fast", Library::kFast, kToday);
  ASSERT_TRUE(identity.ok());
  EXPECT_THAT(SubjectOf(*identity->certificate), MatchesRegex("CN=fusion-fast-[0-9]+,O=Limbcast"));
}

TEST_F(CertificatesTest, DatesAreKeptToTheSecond) {
  const auto validity = ValidityOf(*authority_->certificate);
  ASSERT_TRUE(validity.has_value());
  EXPECT_EQ(validity->from, kToday.from);
  EXPECT_EQ(validity->until, kToday.until);
}

TEST_F(CertificatesTest, PemReadsBack) {
  const auto certificate = CertificateFromPem(ToPem(*authority_->certificate));
  const auto key = KeyFromPem(ToPem(*authority_->key));
  ASSERT_TRUE(certificate.ok() && key.ok());
  EXPECT_TRUE(IsKeyOf(**key, **certificate));
}

TEST_F(CertificatesTest, OtherTextIsRefusedWithTheReason) {
  for (const std::string& text :
       {std::string(), std::string("-----BEGIN"), ToPem(*authority_->key).substr(0, 80)}) {
    const auto certificate = CertificateFromPem(text);
    const auto key = KeyFromPem(text);
    ASSERT_FALSE(certificate.ok() || key.ok());
    EXPECT_EQ(certificate.error().code, ErrorCode::kCorruptData);
    EXPECT_THAT(certificate.error().message, HasSubstr("is no certificate"));
    EXPECT_THAT(key.error().message, HasSubstr("is no private key"));
  }
}

}  // namespace
}  // namespace limbcast::security
