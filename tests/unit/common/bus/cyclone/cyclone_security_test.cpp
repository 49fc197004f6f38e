#include "common/bus/cyclone/cyclone_security.hpp"

#include <gtest/gtest.h>

#include "tests/unit/common/bus/security_cases.hpp"

namespace limbcast::bus::cyclone {
namespace {

class CycloneSecurityTest : public testing::SecurityCases {
 protected:
  CycloneSecurityTest() : SecurityCases(Vendor::kCyclone) {}
};

TEST_F(CycloneSecurityTest, ARoleMayWhatItIsGrantedAndNoMore) {
  ExpectThatARoleMayWhatItIsGrantedAndNoMore();
}

TEST_F(CycloneSecurityTest, ASpectatorPublishesNothing) { ExpectThatASpectatorPublishesNothing(); }

TEST_F(CycloneSecurityTest, CredentialsThatAreNotThereAreNamed) {
  ExpectThatCredentialsThatAreNotThereAreNamed();
}

}  // namespace
}  // namespace limbcast::bus::cyclone
