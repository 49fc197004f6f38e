#include "tools/limbcast/evaluate/recordings.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace limbcast::tool {
namespace {

namespace fs = std::filesystem;

TEST(RecordingsTest, AFolderGivesItsRecordingsByNameAndAFileItself) {
  const fs::path folder =
      fs::temp_directory_path() /
      ("limbcast_recordings_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()));
  fs::create_directories(folder);
  const auto none = RecordingsIn(folder.string());
  ASSERT_FALSE(none.ok());
  EXPECT_NE(none.error().message.find(folder.string()), std::string::npos);
  for (const char* name : {"b.hdf5", "a.csv", "notes.txt"}) {
    std::ofstream(folder / name) << "x";
  }
  const auto files = RecordingsIn(folder.string());
  ASSERT_TRUE(files.ok());
  EXPECT_EQ(*files, (std::vector<fs::path>{folder / "a.csv", folder / "b.hdf5"}));
  fs::remove_all(folder);
  EXPECT_EQ(*RecordingsIn("/one/file.hdf5"), std::vector<fs::path>{"/one/file.hdf5"});
}

}  // namespace
}  // namespace limbcast::tool
