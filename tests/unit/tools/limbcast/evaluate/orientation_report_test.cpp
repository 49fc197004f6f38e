#include "tools/limbcast/evaluate/orientation_report.hpp"
#include "tools/limbcast/report/report_text.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace limbcast::tool {
namespace {

constexpr double kDeg = 3.14159265358979323846 / 180.0;

OrientationResult Result(const std::string& trial, double total_deg) {
  OrientationResult result;
  result.trial = trial;
  result.group = GroupOf(trial);
  result.filter = "bmf";
  result.errors.Add({.total_rad = total_deg * kDeg,
                     .heading_rad = 0.5 * total_deg * kDeg,
                     .inclination_rad = 0.25 * total_deg * kDeg});
  result.points.push_back({.time_s = 0.0, .total_deg = total_deg, .scored = false});
  result.points.push_back({.time_s = 1.0, .total_deg = total_deg, .scored = true});
  return result;
}

const std::vector<OrientationResult> kResults = {
    Result("1_undisturbed_a", 1.0), Result("2_undisturbed_b", 2.0), Result("3_disturbed_<c>", 6.0)};
const ReportHead kHead{.filters = {"bmf"}, .settings = {"bmf.output_lead_s=0.004"}};

TEST(OrientationReportTest, MeansGiveEachTrialTheSameWeight) {
  EXPECT_NEAR(MeanOf(kResults, "bmf").total_deg, 3.0, 1e-9);
  EXPECT_NEAR(MeanOf(kResults, "bmf").median_total_deg, 2.0, 1e-9);
  EXPECT_NEAR(MeanOf(kResults, "bmf", TrialGroup::kUndisturbed).total_deg, 1.5, 1e-9);
  EXPECT_NEAR(MeanOf(kResults, "bmf", TrialGroup::kUndisturbed).median_total_deg, 1.5, 1e-9);
  EXPECT_NEAR(MeanOf(kResults, "bmf", TrialGroup::kDisturbed).heading_deg, 3.0, 1e-9);
  EXPECT_EQ(MeanOf(kResults, "tqt").trials, 0U);
}

TEST(OrientationReportTest, TheTableNamesChangedSettingsTrialsAndMeans) {
  const std::string table = OrientationTable(kHead, kResults);
  EXPECT_NE(table.find("changed: bmf.output_lead_s=0.004"), std::string::npos);
  EXPECT_NE(table.find("2_undisturbed_b"), std::string::npos);
  EXPECT_NE(table.find("mean of all"), std::string::npos);
  EXPECT_NE(table.find("3.000"), std::string::npos);
}

TEST(OrientationReportTest, AnOutputLeadIsStatedUnlessItIsZero) {
  EXPECT_NE(OrientationTable(kHead, kResults).find("output lead is not 0: bmf.output_lead_s=0.004"),
            std::string::npos);
  EXPECT_EQ(OrientationJson(kHead, kResults)["output_leads"].size(), 1U);
  for (const char* setting : {"output_lead_s=0", "bmf.output_lead_s=0.0", "no_output_lead_s=1"}) {
    EXPECT_TRUE(OutputLeads({.filters = {"bmf"}, .settings = {setting}}).empty()) << setting;
  }
}

TEST(OrientationReportTest, JsonHoldsTheSameFigures) {
  const nlohmann::json json = OrientationJson(kHead, kResults);
  EXPECT_NEAR(json["filters"]["bmf"]["all"]["total_deg"].get<double>(), 3.0, 1e-9);
  EXPECT_EQ(json["trials"].size(), 3U);
  EXPECT_EQ(json["trials"][2]["trial"], "3_disturbed_<c>");
}

TEST(OrientationReportTest, HtmlIsOnePageWithAPlotForEachTrialAndEscapesNames) {
  const std::string html = OrientationHtml(kHead, kResults);
  std::size_t plots = 0;
  for (std::size_t at = html.find("<svg"); at != std::string::npos;
       at = html.find("<svg", at + 1)) {
    ++plots;
  }
  EXPECT_EQ(plots, 3U);
  EXPECT_EQ(html.find("<c>"), std::string::npos);
  EXPECT_EQ(html.find("http"), std::string::npos);  // nothing is fetched from elsewhere
}

TEST(OrientationReportTest, ThePlotHasAGapWhereTheTruthIsNotKnown) {
  std::vector<OrientationResult> results = {kResults[0]};
  results[0].points = {{.time_s = 0.0, .total_deg = 1.0},
                       {.time_s = 1.0, .total_deg = 1.0},
                       {.time_s = 2.0, .total_deg = 170.0, .known = false},
                       {.time_s = 3.0, .total_deg = 1.0},
                       {.time_s = 4.0, .total_deg = 1.0}};
  const std::string html = OrientationHtml(kHead, results);
  const std::string path = html.substr(html.rfind(" d='") + 4);
  const std::string drawn = path.substr(0, path.find('\''));
  EXPECT_EQ(std::count(drawn.begin(), drawn.end(), 'M'), 2);
  EXPECT_EQ(std::count(drawn.begin(), drawn.end(), 'L'), 2);
}

TEST(OrientationReportTest, SavesQuaternionsAsCsvAndSaysWhatItCannotWrite) {
  const auto folder =
      std::filesystem::temp_directory_path() /
      ("limbcast_report_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()));
  const auto path = folder / "bmf" / "t.csv";
  const std::vector<Eigen::Quaterniond> rows = {{1.0, 0.0, 0.0, 0.0}, {0.5, -0.5, 0.5, 0.5}};
  ASSERT_TRUE(SaveQuaternions(path, rows).ok());
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  EXPECT_EQ(text.str(), "w,x,y,z\n1,0,0,0\n0.5,-0.5,0.5,0.5\n");
  std::filesystem::remove_all(folder);
  const Status refused = SaveText("/proc/no/such/file", "x");
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("/proc/no/such/file"), std::string::npos);
}

}  // namespace
}  // namespace limbcast::tool
