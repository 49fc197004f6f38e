#include "common/filters/lendable.hpp"

#include <gtest/gtest.h>

namespace limbcast::filters {
namespace {

TEST(LendableTest, IsAPlaceOfItsOwnUntilAnotherIsLent) {
  Lendable<int> value;
  *value = 3;
  int place = 4;
  value.Lend(place);
  EXPECT_EQ(*value, 4) << "whose value is there is said by who lends";
  *value = 5;
  EXPECT_EQ(place, 5);
}

TEST(LendableTest, ACopyHasAPlaceOfItsOwn) {
  Lendable<int> value;
  int place = 4;
  value.Lend(place);
  Lendable<int> copy(value);
  *copy = 6;
  EXPECT_EQ(place, 4);
  value = copy;
  EXPECT_EQ(place, 6) << "assignment gives the value";
  *copy = 7;
  EXPECT_EQ(place, 6);
}

}  // namespace
}  // namespace limbcast::filters
