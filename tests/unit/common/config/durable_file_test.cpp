#include "common/config/durable_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/support/temporary_folder.hpp"

namespace limbcast::config {
namespace {

TEST(DurableFileTest, ReplacesWhatWasThere) {
  const auto path =
      std::filesystem::temp_directory_path() /
      ("limbcast_durable_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()));
  ASSERT_TRUE(WriteDurably(path, "a long first text\n").ok());
  ASSERT_TRUE(WriteDurably(path, "short\n").ok());
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  EXPECT_EQ(text.str(), "short\n");
  std::filesystem::remove(path);
}

TEST(DurableFileTest, NamesTheFileAndTheReason) {
  const Status refused = WriteDurably("/proc/no/such/file", "x");
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::kUnavailable);
  EXPECT_EQ(refused.error().message, "open /proc/no/such/file: No such file or directory");
}

TEST(DurableFileTest, AFullDiskIsToldAndNotFilledSilently) {
  const Status refused = WriteDurably("/dev/full", "x");
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().message, "write /dev/full: No space left on device");
}

TEST(DurableFileTest, AFolderIsMadeOrTheSettingThatNamesItRefused) {
  const test_support::TemporaryFolder folder;
  EXPECT_TRUE(PrepareFolder(folder / "a/b", "x.state_dir").ok());
  EXPECT_TRUE(std::filesystem::is_directory(folder / "a/b"));
  EXPECT_TRUE(PrepareFolder(folder / "a/b", "x.state_dir").ok()) << "is there already";
  const Status refused = PrepareFolder("/proc/no/such", "x.state_dir");
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::kUnavailable);
  EXPECT_EQ(
      refused.error().message,
      "x.state_dir must be a writable folder, is \"/proc/no/such\" (No such file or directory)");
}

}  // namespace
}  // namespace limbcast::config
