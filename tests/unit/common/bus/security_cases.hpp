#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "common/bus/bus_factory.hpp"
#include "common/bus/system_now.hpp"
#include "common/security/create.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/common/bus/test_domain.hpp"

namespace limbcast::bus::testing {

/// What holds for the secured participants of either library.
class SecurityCases : public ::testing::Test {
 protected:
  explicit SecurityCases(Vendor vendor) : vendor_(vendor) {
    using namespace std::chrono_literals;
    security::CreateOptions options;
    options.authority = options.identities = {SystemNow() - 1h, SystemNow() + 1h};
    EXPECT_TRUE(security::Create(folder_ / "credentials", options).ok());
  }

  void ExpectThatARoleMayWhatItIsGrantedAndNoMore() {
    const auto gateway = Open(As("gateway"));
    ASSERT_TRUE(gateway.ok()) << gateway.error().message;
    EXPECT_THAT((*gateway)->Describe(), ::testing::HasSubstr("secured as gateway"));
    EXPECT_TRUE((*gateway)->MakeWriter<sensing::MargSample>().ok());
    const auto skeletons = (*gateway)->MakeWriter<body::Skeleton>();
    ASSERT_FALSE(skeletons.ok());
    EXPECT_THAT(skeletons.error().message,
                ::testing::HasSubstr("security: role \"gateway\" may not publish skeleton"));
  }

  void ExpectThatASpectatorPublishesNothing() {
    const auto spectator = Open(As("spectator"));
    ASSERT_TRUE(spectator.ok()) << spectator.error().message;
    EXPECT_TRUE((*spectator)->MakeReader<body::Skeleton>({}).ok());
    EXPECT_FALSE((*spectator)->MakeWriter<roster::JoinRequest>().ok());
    EXPECT_FALSE((*spectator)->MakeWriter<body::Skeleton>().ok());
  }

  void ExpectThatCredentialsThatAreNotThereAreNamed() {
    const auto king = Open(As("king"));
    ASSERT_FALSE(king.ok());
    EXPECT_THAT(king.error().message, ::testing::HasSubstr("no credentials of role \"king\""));
  }

 private:
  BusConfig As(const std::string& role) {
    BusConfig config = LoopbackConfig(vendor_);
    config.security_dir = folder_ / "credentials";
    config.security_role = role;
    return config;
  }

  const Vendor vendor_;
  const test_support::TemporaryFolder folder_;
};

}  // namespace limbcast::bus::testing
