#include "tools/limbcast/evaluate/parallel.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace limbcast::tool {
namespace {

TEST(ForEachIndexTest, EveryIndexOnceHoweverMany) {
  for (const std::size_t count : {0U, 1U, 2U, 1000U}) {
    std::vector<int> calls(count, 0);
    ForEachIndex(count, [&](std::size_t i) { ++calls[i]; });
    EXPECT_EQ(calls, std::vector<int>(count, 1));
  }
}

}  // namespace
}  // namespace limbcast::tool
