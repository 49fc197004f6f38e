#include "tools/limbcast/bench/users_search.hpp"

#include <gtest/gtest.h>

namespace limbcast::tool {
namespace {

// The answer of a host that carries `limit` people, and the number of runs it took.
std::pair<int, int> Find(int limit, int first, int max) {
  UsersSearch search(first, max);
  int runs = 0;
  while (const auto people = search.next()) {
    EXPECT_GE(*people, 1);
    EXPECT_LE(*people, max);
    search.Add(*people <= limit);
    ++runs;
  }
  return {search.largest(), runs};
}

TEST(UsersSearchTest, FindsTheLargestNumberToATwentieth) {
  for (int limit = 1; limit <= 256; ++limit) {
    const auto [found, runs] = Find(limit, 1, 256);
    EXPECT_LE(found, limit);
    EXPECT_GE(found + std::max(1, found / 20) - 1, limit - 1) << limit;
    EXPECT_LE(runs, 17);
  }
}

TEST(UsersSearchTest, StopsAtTheMostThatIsAskedFor) {
  EXPECT_EQ(Find(1000, 4, 60).first, 60);
  EXPECT_EQ(Find(1000, 7, 7), std::pair(7, 1));
}

TEST(UsersSearchTest, GoesDownWhenTheFirstIsTooMany) {
  EXPECT_EQ(Find(3, 16, 64).first, 3);
  EXPECT_EQ(Find(0, 8, 64).first, 0);
}

TEST(FitLineTest, GivesBackALine) {
  const auto line = FitLine({{1, 5}, {2, 7}, {10, 23}});
  ASSERT_TRUE(line.has_value());
  EXPECT_NEAR(line->offset, 3.0, 1e-12);
  EXPECT_NEAR(line->slope, 2.0, 1e-12);
  EXPECT_NEAR(line->worst_share, 0.0, 1e-12);
}

TEST(FitLineTest, SaysHowFarThePointsAreFromIt) {
  // Least squares through (0,0) (1,0) (2,3): slope 1.5, offset -0.5; residuals 0.5, -1, 0.5.
  const auto line = FitLine({{0, 0}, {1, 0}, {2, 3}});
  ASSERT_TRUE(line.has_value());
  EXPECT_NEAR(line->slope, 1.5, 1e-12);
  EXPECT_NEAR(line->offset, -0.5, 1e-12);
  EXPECT_NEAR(line->worst_share, 1.0 / 3.0, 1e-12);
}

TEST(FitLineTest, OneNumberOfPeopleIsNoLine) {
  EXPECT_FALSE(FitLine({}).has_value());
  EXPECT_FALSE(FitLine({{4, 1}, {4, 2}}).has_value());
}

}  // namespace
}  // namespace limbcast::tool
