#include "common/bus/permission.hpp"

#include <gtest/gtest.h>

namespace limbcast::bus {
namespace {

const Error kRefused{ErrorCode::kUnavailable, "writer of x: not allowed"};

BusConfig Secured(const std::string& role) {
  return {.security_dir = "credentials", .security_role = role};
}

TEST(PermissionTest, NamesTheRoleThatMayNot) {
  const Error error = ExplainRefusal(Secured("gateway"), "publish", "skeleton", kRefused);
  EXPECT_EQ(error.code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(error.message,
            "security: role \"gateway\" may not publish skeleton (writer of x: not allowed)");
  EXPECT_EQ(ExplainRefusal(Secured("spectator"), "subscribe", "marg", kRefused).message,
            "security: role \"spectator\" may not subscribe marg (writer of x: not allowed)");
}

TEST(PermissionTest, BlamesNoRoleThatMay) {
  EXPECT_EQ(ExplainRefusal(Secured("posture"), "publish", "skeleton", kRefused).message,
            kRefused.message);
  EXPECT_EQ(ExplainRefusal({}, "publish", "skeleton", kRefused).message, kRefused.message);
}

TEST(PermissionTest, ARoleOfSomebodyElseIsJudgedByTheLibrary) {
  EXPECT_EQ(ExplainRefusal(Secured("king"), "publish", "skeleton", kRefused).code,
            ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace limbcast::bus
