#include "common/bus/fastdds/fast_security.hpp"

#include <gtest/gtest.h>

#include "tests/unit/common/bus/security_cases.hpp"

namespace limbcast::bus::fastdds {
namespace {

class FastSecurityTest : public testing::SecurityCases {
 protected:
  FastSecurityTest() : SecurityCases(Vendor::kFast) {}
};

TEST_F(FastSecurityTest, ARoleMayWhatItIsGrantedAndNoMore) {
  ExpectThatARoleMayWhatItIsGrantedAndNoMore();
}

TEST_F(FastSecurityTest, ASpectatorPublishesNothing) { ExpectThatASpectatorPublishesNothing(); }

TEST_F(FastSecurityTest, CredentialsThatAreNotThereAreNamed) {
  ExpectThatCredentialsThatAreNotThereAreNamed();
}

}  // namespace
}  // namespace limbcast::bus::fastdds
