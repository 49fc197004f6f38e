#include "tools/limbcast/monitor/health_ledger.hpp"

#include <gtest/gtest.h>

namespace limbcast::tool {
namespace {

ServiceHealth Report(std::uint64_t uid, std::string role, double value, double cpu_seconds = 0.0,
                     double at_s = 0.0) {
  ServiceHealth health;
  health.process_uid = uid;
  health.pid = static_cast<std::uint32_t>(100 + uid);
  health.role = std::move(role);
  health.cpu_seconds = cpu_seconds;
  health.reported_at = Time{DurationFromSeconds(at_s)};
  health.values = {{"samples", value}, {"verdict.fused", value}, {"verdict.time", 1.0}};
  return health;
}

TEST(HealthLedgerTest, LaterReportsOfAProcessReplaceItsEarlierOnes) {
  HealthLedger ledger;
  ledger.Add(Report(1, "fusion", 10));
  ledger.Add(Report(1, "fusion", 25));
  EXPECT_EQ(ledger.Sum("fusion", "samples"), 25);
}

TEST(HealthLedgerTest, ARestartedProcessAddsToWhatTheOldOneSaidLast) {
  HealthLedger ledger;
  ledger.Add(Report(1, "fusion", 10));
  ledger.Add(Report(2, "fusion", 3));
  EXPECT_EQ(ledger.Sum("fusion", "samples"), 13);
  EXPECT_EQ(ledger.SumByName("fusion", "verdict."),
            (std::map<std::string, double>{{"fused", 13.0}, {"time", 2.0}}));
}

TEST(HealthLedgerTest, OtherRolesAndNamesDoNotCount) {
  HealthLedger ledger;
  ledger.Add(Report(1, "gateway", 10));
  EXPECT_EQ(ledger.Sum("fusion", "samples"), 0);
  EXPECT_EQ(ledger.Sum("gateway", "sample"), 0);
  EXPECT_TRUE(ledger.HasRole("gateway"));
  EXPECT_FALSE(ledger.HasRole("fusion"));
}

TEST(HealthLedgerTest, CpuCountsFromTheMarkOrTheFirstReport) {
  HealthLedger ledger;
  ledger.Add(Report(1, "fusion", 0, 5.0, 10.0));
  ledger.Mark();
  ledger.Add(Report(1, "fusion", 0, 5.5, 12.0));
  ledger.Add(Report(2, "fusion", 0, 1.0, 12.0));  // came after the mark
  ledger.Add(Report(2, "fusion", 0, 1.25, 13.0));
  const auto cpu = ledger.CpuByRole();
  EXPECT_DOUBLE_EQ(cpu.at("fusion").cpu_seconds, 0.75);
  EXPECT_DOUBLE_EQ(cpu.at("fusion").span_s, 3.0);
}

TEST(HealthLedgerTest, HasReportedWantsTheProcessAndTheTime) {
  HealthLedger ledger;
  ledger.Add(Report(1, "fusion", 0, 0.0, 10.0));
  EXPECT_TRUE(ledger.HasReported(101, Time{DurationFromSeconds(10.0)}));
  EXPECT_FALSE(ledger.HasReported(101, Time{DurationFromSeconds(10.1)}));
  EXPECT_FALSE(ledger.HasReported(102, Time{DurationFromSeconds(1.0)}));
}

}  // namespace
}  // namespace limbcast::tool
