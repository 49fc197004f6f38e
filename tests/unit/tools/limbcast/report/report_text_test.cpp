#include "tools/limbcast/report/report_text.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace limbcast::tool {
namespace {

TEST(ReportTextTest, WritesAWholeFileAndTheFoldersAboveIt) {
  const auto folder =
      std::filesystem::temp_directory_path() /
      ("limbcast_report_text_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()));
  const auto path = folder / "a" / "b.txt";
  ASSERT_TRUE(SaveText(path, "one\ntwo\n").ok());
  ASSERT_TRUE(SaveText(path, "three\n").ok());
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  EXPECT_EQ(text.str(), "three\n");
  std::filesystem::remove_all(folder);
}

TEST(ReportTextTest, MarkupInTextIsText) {
  EXPECT_EQ(EscapedHtml("a <b> & c"), "a &lt;b> &amp; c");
}

}  // namespace
}  // namespace limbcast::tool
