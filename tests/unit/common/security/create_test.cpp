#include "common/security/create.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "common/security/credentials.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/common/security/security_examples.hpp"

namespace limbcast::security {
namespace {

using ::testing::HasSubstr;
using namespace testing;
using test_support::TemporaryFolder;

mode_t ModeOf(const std::filesystem::path& path) {
  struct stat status {};
  EXPECT_EQ(stat(path.c_str(), &status), 0) << path;
  return status.st_mode & 0777U;
}

class CreateTest : public ::testing::Test {
 protected:
  const TemporaryFolder temporary_;
  const std::filesystem::path folder_ = temporary_ / "credentials";
};

TEST_F(CreateTest, EveryRoleIsInOrderForBothLibraries) {
  ASSERT_TRUE(Create(folder_, ForToday()).ok());
  for (const RoleGrant& grant : DefaultRoles()) {
    for (const auto library : {Library::kCyclone, Library::kFast}) {
      const auto files = CheckCredentials(folder_, grant.role, library, kNow);
      EXPECT_TRUE(files.ok()) << files.error().message;
    }
  }
}

TEST_F(CreateTest, PrivateKeysAreForTheirOwnerOnly) {
  ASSERT_TRUE(Create(folder_, ForToday()).ok());
  EXPECT_EQ(ModeOf(folder_ / "private"), 0700U);
  EXPECT_EQ(ModeOf(folder_ / "private" / "ca.key"), 0600U);
  EXPECT_EQ(ModeOf(folder_ / "gateway" / "cyclone.key"), 0600U);
}

TEST_F(CreateTest, WhatIsThereIsNotOverwritten) {
  ASSERT_TRUE(Create(folder_, ForToday()).ok());
  const std::string before = Read(folder_ / "ca.pem");
  const Status again = Create(folder_, ForToday());
  ASSERT_FALSE(again.ok());
  EXPECT_EQ(again.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(again.error().message, HasSubstr("is there already"));
  EXPECT_EQ(Read(folder_ / "ca.pem"), before);
}

TEST_F(CreateTest, RenewedOnesAreNewAndOfTheSameAuthority) {
  ASSERT_TRUE(Create(folder_, ForToday()).ok());
  const std::string authority = Read(folder_ / "ca.pem");
  const std::string before = Read(folder_ / "fusion" / "fast.pem");
  CreateOptions later = ForToday();
  later.identities = {kNow + 24h, kNow + 48h};
  ASSERT_TRUE(Renew(folder_, later).ok());
  EXPECT_EQ(Read(folder_ / "ca.pem"), authority);
  EXPECT_NE(Read(folder_ / "fusion" / "fast.pem"), before);
  EXPECT_TRUE(CheckCredentials(folder_, "fusion", Library::kFast, kNow + 36h).ok());
}

TEST_F(CreateTest, RenewNeedsTheKeyOfTheAuthority) {
  ASSERT_TRUE(Create(folder_, ForToday()).ok());
  Replace(folder_ / "private" / "ca.key", Read(folder_ / "fusion" / "fast.key"));
  const Status renewed = Renew(folder_, ForToday());
  ASSERT_FALSE(renewed.ok());
  EXPECT_THAT(renewed.error().message, HasSubstr("is not the key of"));
  std::filesystem::remove(folder_ / "private" / "ca.key");
  EXPECT_EQ(Renew(folder_, ForToday()).error().code, ErrorCode::kNotFound);
}

TEST_F(CreateTest, AFolderThatCannotBeMadeIsNamed) {
  Replace(folder_, "a file");
  const Status created = Create(folder_ / "below", ForToday());
  ASSERT_FALSE(created.ok());
  EXPECT_EQ(created.error().code, ErrorCode::kUnavailable);
  EXPECT_THAT(created.error().message, HasSubstr(folder_.string()));
}

}  // namespace
}  // namespace limbcast::security
