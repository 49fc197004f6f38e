#include "common/security/credentials.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/security/create.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/common/security/security_examples.hpp"

namespace limbcast::security {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using namespace testing;
using test_support::TemporaryFolder;

class CredentialsTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    made_ = std::make_unique<TemporaryFolder>();
    ASSERT_TRUE(Create(*made_ / "ours", ForToday()).ok());
    ASSERT_TRUE(Create(*made_ / "theirs", ForToday()).ok());
  }
  static void TearDownTestSuite() { made_.reset(); }

  CredentialsTest() { fs::copy(*made_ / "ours", folder_, fs::copy_options::recursive); }
  void CopyTo(const fs::path& target, const fs::path& source) {
    fs::copy_file(source, folder_ / target, fs::copy_options::overwrite_existing);
  }
  // The refusal of fusion's credentials for Cyclone DDS.
  Error Refusal(Time now = kNow) {
    const auto files = CheckCredentials(folder_, "fusion", Library::kCyclone, now);
    EXPECT_FALSE(files.ok());
    return files.ok() ? Error{} : files.error();
  }

  static inline std::unique_ptr<TemporaryFolder> made_;
  const TemporaryFolder temporary_;
  const fs::path folder_ = temporary_ / "credentials";
};

TEST_F(CredentialsTest, InOrderTheyAreNamedAbsolutely) {
  const auto files = CheckCredentials(folder_, "fusion", Library::kCyclone, kNow);
  ASSERT_TRUE(files.ok()) << files.error().message;
  EXPECT_TRUE(files->key.is_absolute());
  EXPECT_EQ(files->key, folder_ / "fusion" / "cyclone.key");
}

TEST_F(CredentialsTest, WhatIsMissingIsNamed) {
  fs::remove(folder_ / "fusion" / "cyclone.key");
  EXPECT_THAT(Refusal().message,
              AllOf(StartsWith("security: "), HasSubstr("cyclone.key cannot be read: No such")));
  fs::remove(folder_ / "governance.p7s");
  EXPECT_THAT(Refusal().message, HasSubstr("governance.p7s cannot be read"));
  fs::remove_all(folder_ / "fusion");
  EXPECT_THAT(Refusal().message, HasSubstr("no credentials of role \"fusion\""));
  fs::remove_all(folder_);
  EXPECT_EQ(Refusal().code, ErrorCode::kNotFound);
  EXPECT_THAT(Refusal().message, HasSubstr("limbcast security create"));
}

TEST_F(CredentialsTest, ExpiredOnesSaySinceWhen) {
  const Error expired = Refusal(kNow + 13h);
  EXPECT_EQ(expired.code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(expired.message,
              AllOf(HasSubstr("cyclone.pem has expired at " + IsoText(kToday.until)),
                    HasSubstr("limbcast security renew")));
  EXPECT_THAT(Refusal(kNow + 300h).message, HasSubstr("ca.pem has expired"));
}

TEST_F(CredentialsTest, OnesOfTheFutureAskForTheClock) {
  EXPECT_THAT(Refusal(kNow - 13h).message,
              AllOf(HasSubstr("is not valid before"), HasSubstr("clock")));
}

TEST_F(CredentialsTest, AnIdentityOfAnotherAuthorityIsRefused) {
  CopyTo("fusion/cyclone.pem", *made_ / "theirs" / "fusion" / "cyclone.pem");
  const Error refused = Refusal();
  EXPECT_EQ(refused.code, ErrorCode::kCorruptData);
  EXPECT_THAT(refused.message, HasSubstr("cyclone.pem was not signed by"));
}

TEST_F(CredentialsTest, DocumentsOfAnotherAuthorityAreRefused) {
  CopyTo("fusion/cyclone.p7s", *made_ / "theirs" / "fusion" / "cyclone.p7s");
  EXPECT_THAT(Refusal().message, HasSubstr("cyclone.p7s was changed, or signed by another"));
  CopyTo("governance.p7s", *made_ / "theirs" / "governance.p7s");
  EXPECT_THAT(Refusal().message, HasSubstr("governance.p7s was changed, or signed by another"));
}

TEST_F(CredentialsTest, PermissionsOfAnotherRoleAreRefused) {
  CopyTo("fusion/cyclone.p7s", folder_ / "posture" / "cyclone.p7s");
  EXPECT_THAT(Refusal().message, AllOf(HasSubstr("is for \"CN=posture-cyclone"),
                                       HasSubstr("the identity is \"CN=fusion-cyclone")));
}

TEST_F(CredentialsTest, AKeyOfAnotherIdentityIsRefused) {
  CopyTo("fusion/cyclone.key", folder_ / "posture" / "cyclone.key");
  EXPECT_THAT(Refusal().message, HasSubstr("cyclone.key is not the key of"));
}

TEST_F(CredentialsTest, AnIdentityForTheOtherLibraryIsRefused) {
  for (const char* ending : {".pem", ".key", ".p7s"}) {
    CopyTo(fs::path("fusion") / (std::string("cyclone") + ending),
           folder_ / "fusion" / (std::string("fast") + ending));
  }
  EXPECT_THAT(Refusal().message, HasSubstr("would not shake hands"));
}

TEST_F(CredentialsTest, FilesCutOffAnywhereAreRefusedByName) {
  for (const char* name : {"ca.pem", "governance.p7s", "fusion/cyclone.pem", "fusion/cyclone.key",
                           "fusion/cyclone.p7s"}) {
    const std::string whole = Read(folder_ / name);
    for (const std::size_t length : {std::size_t{0}, whole.size() / 2}) {
      Replace(folder_ / name, whole.substr(0, length));
      EXPECT_THAT(Refusal().message, HasSubstr(name)) << length;
    }
    Replace(folder_ / name, whole);
  }
}

TEST_F(CredentialsTest, ValidityIsToldWithoutBeingJudged) {
  const auto validity = ValidityOf(folder_, "fusion", Library::kFast);
  ASSERT_TRUE(validity.ok());
  EXPECT_EQ(validity->until, kToday.until);
}

}  // namespace
}  // namespace limbcast::security
