#include "services/gateway/gateway_summary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace limbcast::gateway {
namespace {

TEST(GatewaySummaryTest, JsonHoldsEveryNumberByName) {
  GatewaySummary summary;
  summary.driver = "replay";
  summary.published.marg = 5;
  summary.published.orientation = 2;
  summary.samples_unanswered = 3;
  summary.by_sensor.push_back({.label = "head", .published = 7, .unanswered = 3});
  const nlohmann::json json = nlohmann::json::parse(ToJson(summary));
  EXPECT_EQ(json["driver"], "replay");
  EXPECT_EQ(json["end"], "running");
  EXPECT_EQ(json["samples_published"], 7);
  EXPECT_EQ(json["samples_unanswered"], 3);
  EXPECT_EQ(json["by_sensor"]["head"]["published"], 7);
}

TEST(GatewaySummaryTest, SensorsOfOneNameStayApart) {
  GatewaySummary summary;
  summary.by_sensor = {{.label = "head", .published = 1, .unanswered = 0},
                       {.label = "head", .published = 2, .unanswered = 0}};
  EXPECT_EQ(nlohmann::json::parse(ToJson(summary))["by_sensor"].size(), 2U);
}

TEST(GatewaySummaryTest, BytesThatAreNoTextDoNotBreakTheJson) {
  GatewaySummary summary;
  summary.source = "bad \xff\xfe name";
  EXPECT_TRUE(nlohmann::json::accept(ToJson(summary)));
}

TEST(GatewaySummaryTest, TextIsOneLine) {
  EXPECT_THAT(ToText(GatewaySummary{}), ::testing::Not(::testing::HasSubstr("\n")));
}

}  // namespace
}  // namespace limbcast::gateway
