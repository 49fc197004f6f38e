#include "common/bus/inproc/partition.hpp"

#include <gtest/gtest.h>

namespace limbcast::bus::inproc {
namespace {

TEST(PartitionTest, EqualNamesMatchOthersDoNot) {
  EXPECT_TRUE(PartitionsMatch("", ""));
  EXPECT_TRUE(PartitionsMatch("hall", "hall"));
  EXPECT_FALSE(PartitionsMatch("hall", "hall2"));
  EXPECT_FALSE(PartitionsMatch("hall", ""));
}

TEST(PartitionTest, AWildcardOnEitherSideMatchesNames) {
  EXPECT_TRUE(PartitionsMatch("*", "hall"));
  EXPECT_TRUE(PartitionsMatch("hall", "*"));
  EXPECT_TRUE(PartitionsMatch("*", ""));
  EXPECT_TRUE(PartitionsMatch("sess*", "sess1"));
  EXPECT_TRUE(PartitionsMatch("sess*", "sess"));
  EXPECT_FALSE(PartitionsMatch("sess*", "hall"));
  EXPECT_TRUE(PartitionsMatch("s?ss1", "sess1"));
  EXPECT_FALSE(PartitionsMatch("s?ss1", "sss1"));
  EXPECT_TRUE(PartitionsMatch("*a*b*", "xxaxxabx"));
  EXPECT_FALSE(PartitionsMatch("*a*b", "xxaxxabx"));
  EXPECT_TRUE(PartitionsMatch("*ab", "aab"));
}

TEST(PartitionTest, TwoPatternsMatchOnlyWhenEqual) {
  EXPECT_TRUE(PartitionsMatch("s*", "s*"));
  EXPECT_FALSE(PartitionsMatch("*", "s*"));
}

}  // namespace
}  // namespace limbcast::bus::inproc
