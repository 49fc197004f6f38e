#include "tools/limbcast/bench/churn_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace limbcast::tool {
namespace {

using ::testing::HasSubstr;

ChurnCount Usual() {
  ChurnCount count;
  count.all_there_s = 1.5;
  for (const char* name : {"session", "fusion", "posture", "client"}) {
    count.processes[name] = {.threads = 10, .files = 20, .rss_mib = 30.0};
  }
  count.shared_memory_files = 3;
  return count;
}

TEST(ChurnReportTest, WhatIsGivenBackIsNoLeak) {
  ChurnCount now = Usual();
  now.processes["fusion"] = {.threads = 9, .files = 19, .rss_mib = 37.0};
  EXPECT_EQ(LeakOf(Usual(), now, {}), "");
  EXPECT_EQ(LeakOf(Usual(), Usual(), {}), "");
}

TEST(ChurnReportTest, EachThingThatIsKeptIsNamedWithBothValues) {
  ChurnCount threads = Usual();
  threads.processes["fusion"].threads = 11;
  EXPECT_EQ(LeakOf(Usual(), threads, {}), "fusion has 11 threads, had 10");
  ChurnCount files = Usual();
  files.processes["posture"].files = 21;
  EXPECT_EQ(LeakOf(Usual(), files, {}), "posture has 21 open files, had 20");
  ChurnCount memory = Usual();
  memory.processes["session"].rss_mib = 38.5;
  EXPECT_EQ(LeakOf(Usual(), memory, {}), "session holds 38.5 MiB, held 30.0, at most 8.0 more");
  ChurnCount shared = Usual();
  shared.shared_memory_files = 4;
  EXPECT_EQ(LeakOf(Usual(), shared, {}), "4 files in /dev/shm, were 3");
  ChurnCount people = Usual();
  people.people = {"P1 in the roster", "body 2"};
  EXPECT_EQ(LeakOf(Usual(), people, {}), "still there: P1 in the roster, body 2");
  ChurnCount late = Usual();
  late.all_there_s = -1.0;
  EXPECT_THAT(LeakOf(Usual(), late, {}), HasSubstr("skeleton"));
}

TEST(ChurnReportTest, ItIsGoodOnlyWithTwoCountsAndNothingAmiss) {
  EXPECT_FALSE(ChurnJson({Usual()}, {}, {})["ok"].get<bool>());
  EXPECT_TRUE(ChurnJson({Usual(), Usual()}, {}, {})["ok"].get<bool>());
  ChurnCount leaked = Usual();
  leaked.people = {"body 1", "body 2"};
  EXPECT_FALSE(ChurnJson({Usual(), leaked, Usual()}, {}, {})["ok"].get<bool>());
  ChurnEvents events;
  events.killed["fusion"] = 2;
  events.failures = {"posture: status 0, signal 11: "};
  const nlohmann::json report = ChurnJson({Usual(), Usual()}, events, {});
  EXPECT_FALSE(report["ok"].get<bool>());
  EXPECT_THAT(ChurnText(report), HasSubstr("killed: fusion 2 times"));
  EXPECT_THAT(ChurnText(report), HasSubstr("failed: posture: status 0, signal 11"));
}

}  // namespace
}  // namespace limbcast::tool
