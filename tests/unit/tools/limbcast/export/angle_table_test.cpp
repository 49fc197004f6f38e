#include "tools/limbcast/export/angle_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

namespace limbcast::tool {
namespace {

using namespace std::chrono_literals;

constexpr Time kStart = Time{} + 100s;

body::JointAngleFrame Frame(Time at, float knee_rad) {
  body::JointAngleFrame frame;
  frame.measured_at = at;
  frame.joints.push_back({.joint = body::Joint::kRightKnee,
                          .confidence = 0.5F,
                          .angle_rad = {knee_rad, 0.25F, -0.5F}});
  return frame;
}

std::vector<std::string> Split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, at);) {
    parts.push_back(part);
  }
  return parts;
}

std::size_t ColumnOf(const std::vector<std::string>& header, const std::string& name) {
  const auto found = std::find(header.begin(), header.end(), name);
  EXPECT_NE(found, header.end()) << name;
  return static_cast<std::size_t>(found - header.begin());
}

TEST(AngleTableTest, CsvHasANamedColumnForEveryAngleAndARowForEveryFrame) {
  AngleTable table;
  table.Add(Frame(kStart, 1.0F));
  table.Add(Frame(kStart + 10ms, 1.125F));
  const auto lines = Split(table.Text(AngleFormat::kCsv, "walk"), '\n');
  ASSERT_EQ(lines.size(), 3U);
  const auto header = Split(lines[0], ',');
  EXPECT_EQ(header.size(), 1 + 4 * body::kJointCount);
  EXPECT_EQ(header[0], "time_s");
  const auto row = Split(lines[2], ',');
  ASSERT_EQ(row.size(), header.size());
  EXPECT_EQ(row[0], "0.010000");
  EXPECT_EQ(row[ColumnOf(header, "right_knee_flexion_rad")], "1.125000");
  EXPECT_EQ(row[ColumnOf(header, "right_knee_internal_rotation_rad")], "-0.500000");
  EXPECT_EQ(row[ColumnOf(header, "right_knee_confidence")], "0.500");
  EXPECT_EQ(row[ColumnOf(header, "left_knee_flexion_rad")], "") << "the body lacks it";
}

TEST(AngleTableTest, MotHasTheHeaderOfOpenSim) {
  AngleTable table;
  table.Add(Frame(kStart, 1.0F));
  const auto lines = Split(table.Text(AngleFormat::kMot, "walk"), '\n');
  ASSERT_EQ(lines.size(), 9U);
  EXPECT_EQ(lines[0], "walk");
  EXPECT_EQ(lines[1], "version=1");
  EXPECT_EQ(lines[2], "nRows=1");
  EXPECT_EQ(lines[3], "nColumns=46");
  EXPECT_EQ(lines[4], "inDegrees=no");
  EXPECT_EQ(lines[6], "endheader");
  const auto header = Split(lines[7], '\t');
  const auto row = Split(lines[8], '\t');
  EXPECT_EQ(header.size(), 46U);
  ASSERT_EQ(row.size(), 46U);
  EXPECT_EQ(header[0], "time");
  EXPECT_EQ(row[ColumnOf(header, "right_knee_flexion_rad")], "1.000000");
  EXPECT_EQ(row[ColumnOf(header, "left_knee_flexion_rad")], "nan");
}

TEST(AngleTableTest, TimesOfAFileRise) {
  AngleTable table;
  table.Add(Frame(kStart, 1.0F));
  table.Add(Frame(kStart, 2.0F));
  table.Add(Frame(kStart - 10ms, 3.0F));
  EXPECT_EQ(table.rows(), 1U);
}

TEST(AngleTableTest, TheNameOfTheFileChoosesTheFormat) {
  EXPECT_EQ(AngleFormatOf("a/walk.mot"), AngleFormat::kMot);
  EXPECT_EQ(AngleFormatOf("walk.sto"), AngleFormat::kMot);
  EXPECT_EQ(AngleFormatOf("walk.csv"), AngleFormat::kCsv);
  EXPECT_EQ(AngleFormatOf(""), AngleFormat::kCsv);
}

}  // namespace
}  // namespace limbcast::tool
