#include "common/base/result.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

namespace limbcast {
namespace {

Result<int> Half(int value) {
  if (value % 2 != 0) {
    return Error{ErrorCode::kInvalidArgument, "value must be even, is " + std::to_string(value)};
  }
  return value / 2;
}

TEST(ResultTest, CarriesTheValueOfASuccess) {
  const Result<int> half = Half(8);
  ASSERT_TRUE(half.ok());
  EXPECT_EQ(*half, 4);
}

TEST(ResultTest, CarriesTheErrorOfARefusal) {
  const Result<int> half = Half(7);
  ASSERT_FALSE(half);
  EXPECT_EQ(half.error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(half.error().message, "value must be even, is 7");
}

TEST(ResultTest, MovesWhatCannotBeCopied) {
  Result<std::unique_ptr<int>> made{std::make_unique<int>(3)};
  const std::unique_ptr<int> taken = *std::move(made);
  EXPECT_EQ(*taken, 3);
}

TEST(ResultDeathTest, AbortsWhenTheWrongSideIsRead) {
  const Result<int> refused = Half(1);
  EXPECT_DEATH(static_cast<void>(*refused), "a Result with a value");
  const Result<int> fine = Half(2);
  EXPECT_DEATH(static_cast<void>(fine.error()), "a Result with an error");
}

TEST(StatusTest, IsFineUntilItCarriesAnError) {
  EXPECT_TRUE(Ok().ok());
  const Status refused = Error{ErrorCode::kTimeout, "no answer in 2 s"};
  EXPECT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "no answer in 2 s");
}

}  // namespace
}  // namespace limbcast
