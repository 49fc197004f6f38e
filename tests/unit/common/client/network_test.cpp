#include "common/client/network.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace limbcast::client {
namespace {

using ::testing::HasSubstr;

TEST(NetworkTest, ASessionIsAPartition) {
  ClientOptions options;
  options.dds = "inproc";
  options.domain_id = 9;
  options.partition = "lobby";
  EXPECT_THAT((*OpenNetwork(options))->Describe(), HasSubstr("domain 9, partition \"lobby\""));
  options.session = "stage";
  EXPECT_THAT((*OpenNetwork(options))->Describe(), HasSubstr("partition \"stage\""));
}

TEST(NetworkTest, OnlySpectatorsOfASecuredNetworkOnlyListen) {
  ClientOptions options;
  EXPECT_FALSE(OnlyListens(options));
  options.security_dir = "credentials";
  EXPECT_TRUE(OnlyListens(options));
  options.security_role = "operator";
  EXPECT_FALSE(OnlyListens(options));
  options.security_role.clear();
  options.role = roster::Role::kPerformer;
  EXPECT_FALSE(OnlyListens(options));
}

TEST(NetworkTest, CredentialsAreLookedForByTheRoleInTheSession) {
  ClientOptions options;
  options.security_dir = "/";
  for (const auto& [role, name] : {std::pair{roster::Role::kSpectator, "spectator"},
                                   {roster::Role::kPerformer, "performer"},
                                   {roster::Role::kOperator, "operator"}}) {
    options.role = role;
    EXPECT_THAT(OpenNetwork(options).error().message,
                HasSubstr("no credentials of role \"" + std::string(name)));
  }
  options.dds = "inproc";
  EXPECT_THAT(OpenNetwork(options).error().message, HasSubstr("bus.security_dir"));
}

TEST(NetworkTest, BadOptionsAreRefusedByName) {
  ClientOptions options;
  options.dds = "inproc";
  options.session = "a,b";
  EXPECT_THAT(OpenNetwork(options).error().message, HasSubstr("a,b"));
  options.session.clear();
  options.network = "eth0;rm";
  EXPECT_THAT(OpenNetwork(options).error().message, HasSubstr("eth0;rm"));
}

}  // namespace
}  // namespace limbcast::client
