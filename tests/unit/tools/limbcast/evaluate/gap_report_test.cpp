#include "tools/limbcast/evaluate/gap_report.hpp"

#include <gtest/gtest.h>

namespace limbcast::tool {
namespace {

GapResult Result(const std::string& trial, double gap_s, int ratio, double error_m) {
  GapResult result;
  result.trial = trial;
  result.gap_s = gap_s;
  result.ratio = ratio;
  result.gaps = ratio == 0 ? 10 : 0;
  for (FillFigure& figure : result.fills) {
    figure = {.mean_max_m = error_m,
              .worst_max_m = 3.0 * error_m,
              .mean_max_z_m = 0.5 * error_m,
              .rms_m = error_m,
              .max_m = 4.0 * error_m,
              .mean_nees = 3.0};
  }
  return result;
}

const std::vector<GapResult> kResults = {Result("a", 0.5, 0, 0.001), Result("b", 0.5, 0, 0.003),
                                         Result("a", 0.0, 100, 0.002),
                                         Result("b", 0.0, 100, 0.004)};

TEST(GapReportTest, MeansGiveEachTrialTheSameWeight) {
  const GapResult gaps = MeanOfGaps(kResults, 0.5, 0);
  EXPECT_NEAR(gaps.fills[2].mean_max_m, 0.002, 1e-12);
  EXPECT_NEAR(gaps.fills[2].worst_max_m, 0.009, 1e-12);
  EXPECT_EQ(gaps.gaps, 20U);
  const GapResult ratio = MeanOfGaps(kResults, 0.0, 100);
  EXPECT_NEAR(ratio.fills[0].rms_m, 0.003, 1e-12);
  EXPECT_NEAR(ratio.fills[0].max_m, 0.016, 1e-12);
  EXPECT_EQ(MeanOfGaps(kResults, 1.0, 0).fills[0].mean_max_m, 0.0);
}

TEST(GapReportTest, TheTableStandsBesideWhatIsAskedAndPublished) {
  const std::vector<std::string> settings = {"lag_s=0.8"};
  const std::string table = GapTable(kResults, settings);
  for (const char* text : {"changed: lag_s=0.8", "gaps of 0.5 s", "mean of 2 trials",
                           "plain implementation", "goal", "ratio 100, RMS: forward 15"}) {
    EXPECT_NE(table.find(text), std::string::npos) << text;
  }
}

TEST(GapReportTest, TheJsonHasTheSameFiguresInMetres) {
  const nlohmann::json json = GapJson(kResults, {});
  ASSERT_EQ(json["trials"].size(), 4U);
  ASSERT_EQ(json["means"].size(), 2U);
  EXPECT_NEAR(json["means"][0]["smoothed"]["mean_max_m"].get<double>(), 0.002, 1e-12);
  EXPECT_NEAR(json["means"][0]["plain_implementation_m"]["smoothed"].get<double>(), 0.0018, 1e-12);
  EXPECT_NEAR(json["means"][1]["forward"]["rms_m"].get<double>(), 0.003, 1e-12);
  EXPECT_FALSE(json["means"][1].contains("spline"));
  EXPECT_TRUE(json.contains("placement"));
}

}  // namespace
}  // namespace limbcast::tool
