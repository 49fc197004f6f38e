#include "common/bus/cyclone/cyclone_security.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "common/bus/bus_factory.hpp"
#include "common/bus/system_now.hpp"
#include "common/security/create.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/common/bus/test_domain.hpp"

namespace limbcast::bus::cyclone {
namespace {

using namespace std::chrono_literals;
using bus::testing::LoopbackConfig;
using ::testing::HasSubstr;

class CycloneSecurityTest : public ::testing::Test {
 protected:
  CycloneSecurityTest() {
    security::CreateOptions options;
    options.authority = options.identities = {SystemNow() - 1h, SystemNow() + 1h};
    EXPECT_TRUE(security::Create(folder_ / "credentials", options).ok());
  }
  BusConfig As(const std::string& role) {
    BusConfig config = LoopbackConfig(Vendor::kCyclone);
    config.security_dir = folder_ / "credentials";
    config.security_role = role;
    return config;
  }
  const test_support::TemporaryFolder folder_;
};

TEST_F(CycloneSecurityTest, ARoleMayWhatItIsGrantedAndNoMore) {
  const auto gateway = Open(As("gateway"));
  ASSERT_TRUE(gateway.ok()) << gateway.error().message;
  EXPECT_THAT((*gateway)->Describe(), HasSubstr("secured as gateway"));
  EXPECT_TRUE((*gateway)->MakeWriter<sensing::MargSample>().ok());
  const auto skeletons = (*gateway)->MakeWriter<body::Skeleton>();
  ASSERT_FALSE(skeletons.ok());
  EXPECT_THAT(skeletons.error().message,
              HasSubstr("security: role \"gateway\" may not publish skeleton"));
}

TEST_F(CycloneSecurityTest, ASpectatorPublishesNothing) {
  const auto spectator = Open(As("spectator"));
  ASSERT_TRUE(spectator.ok()) << spectator.error().message;
  EXPECT_TRUE((*spectator)->MakeReader<body::Skeleton>({}).ok());
  EXPECT_FALSE((*spectator)->MakeWriter<roster::JoinRequest>().ok());
  EXPECT_FALSE((*spectator)->MakeWriter<body::Skeleton>().ok());
}

TEST_F(CycloneSecurityTest, CredentialsThatAreNotThereAreNamed) {
  const auto king = Open(As("king"));
  ASSERT_FALSE(king.ok());
  EXPECT_THAT(king.error().message, HasSubstr("no credentials of role \"king\""));
}

}  // namespace
}  // namespace limbcast::bus::cyclone
