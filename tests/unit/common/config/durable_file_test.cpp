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

std::string TextOf(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

TEST(DurableFileTest, ReplacingKeepsTheOldOneUnderAnotherName) {
  const test_support::TemporaryFolder folder;
  const auto path = folder / "a.toml";
  ASSERT_TRUE(ReplaceDurably(path, "1", folder / "a.toml.old").ok());
  EXPECT_FALSE(std::filesystem::exists(folder / "a.toml.old")) << "there was none";
  ASSERT_TRUE(ReplaceDurably(path, "2", folder / "a.toml.old").ok());
  ASSERT_TRUE(ReplaceDurably(path, "3", folder / "a.toml.old").ok());
  EXPECT_EQ(TextOf(path), "3");
  EXPECT_EQ(TextOf(folder / "a.toml.old"), "2");
  ASSERT_TRUE(ReplaceDurably(path, "4").ok());
  EXPECT_EQ(TextOf(path), "4");
  EXPECT_EQ(TextOf(folder / "a.toml.old"), "2");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.toml.new"));
}

TEST(DurableFileTest, WhatCannotBeReplacedStaysAsItWas) {
  const test_support::TemporaryFolder folder;
  const auto path = folder / "a.toml";
  ASSERT_TRUE(ReplaceDurably(path, "1").ok());
  std::filesystem::create_directory(folder / "kept");  // a copy cannot take its place
  const Status kept = ReplaceDurably(path, "2", folder / "kept");
  ASSERT_FALSE(kept.ok());
  EXPECT_EQ(kept.error().code, ErrorCode::kUnavailable);
  EXPECT_NE(kept.error().message.find("copy to"), std::string::npos) << kept.error().message;
  EXPECT_EQ(TextOf(path), "1");
  std::filesystem::remove(folder / "a.toml.new");
  std::filesystem::create_symlink("/dev/full", folder / "a.toml.new");
  EXPECT_FALSE(ReplaceDurably(path, "2").ok());
  EXPECT_EQ(TextOf(path), "1");
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
