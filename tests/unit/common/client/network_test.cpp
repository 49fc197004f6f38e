#include "common/client/network.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
