#include "tools/limbcast/evaluate/position_csv.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <vector>

namespace limbcast::tool {
namespace {

std::vector<std::string> LinesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

TEST(PositionCsvTest, EveryLineHasACellForEachColumn) {
  std::vector<filters::PositionEstimate> estimates(3);
  estimates[0].fill = filters::FillKind::kNone;
  estimates[1].at = Time{} + std::chrono::milliseconds(5);
  estimates[1].fill = filters::FillKind::kMeasured;
  estimates[1].p_earth_marker_m = {0.125, -0.5, 1.0};
  estimates[1].cov_position_m2 = 1e-6 / 3.0 * Eigen::Matrix3d::Identity();
  estimates[2] = estimates[1];
  estimates[2].fill = filters::FillKind::kPolynomial;
  estimates[2].has_motion = false;
  const auto lines = LinesOf(PositionCsv(estimates));
  ASSERT_EQ(lines.size(), 4U);
  const auto commas = std::count(lines[0].begin(), lines[0].end(), ',');
  for (const std::string& line : lines) {
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), commas) << line;
  }
  EXPECT_EQ(lines[1].substr(0, 7), "0,none,");
  EXPECT_EQ(lines[2].substr(0, 41), "0.005,measured,0,0.001,0.125,-0.5,1,0,0,0");
  EXPECT_NE(lines[3].find("polynomial,0,0.001,0.125,-0.5,1,,"), std::string::npos);
}

TEST(PositionCsvTest, TheSummarySaysWhatWasFoundOrWhyNot) {
  filters::OfflineResult result;
  EXPECT_NE(SmoothSummary(result).find("never started"), std::string::npos);
  result.estimates.resize(1);
  result.start.marker_lead_s = 0.0042;
  EXPECT_NE(SmoothSummary(result).find("lead by 4.20 ms"), std::string::npos);
}

}  // namespace
}  // namespace limbcast::tool
