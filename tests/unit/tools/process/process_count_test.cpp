#include "tools/process/process_count.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <latch>
#include <thread>

#include "tests/support/temporary_folder.hpp"

namespace limbcast::process {
namespace {

TEST(ProcessCountTest, ThreadsAndFilesOfThisProcessAreCounted) {
  const test_support::TemporaryFolder folder;
  const auto before = CountOf(getpid());
  ASSERT_TRUE(before.ok());
  {
    const std::ofstream file(folder / "file");
    std::latch end(1);
    std::thread thread([&] { end.wait(); });
    const auto during = CountOf(getpid());
    end.count_down();
    thread.join();
    ASSERT_TRUE(during.ok());
    EXPECT_EQ(during->threads, before->threads + 1);
    EXPECT_EQ(during->files, before->files + 1);
    EXPECT_GT(during->rss_mib, 1.0);
  }
  EXPECT_EQ(CountOf(getpid())->files, before->files);
}

TEST(ProcessCountTest, WhatAProcessReadsOfItselfIsNoOpenFile) {
  const auto before = CountOf(getpid());
  const std::ifstream statm("/proc/self/statm");
  const std::ifstream stat("/proc/stat");
  ASSERT_TRUE(statm.is_open() && stat.is_open());
  EXPECT_EQ(CountOf(getpid())->files, before->files);
}

TEST(ProcessCountTest, AProcessThatIsNotThereIsNamed) {
  const auto none = CountOf(999'999'999);
  ASSERT_FALSE(none.ok());
  EXPECT_EQ(none.error().code, ErrorCode::kNotFound);
  EXPECT_NE(none.error().message.find("999999999"), std::string::npos);
}

TEST(ProcessCountTest, FilesOfAFolderAreCounted) {
  const test_support::TemporaryFolder folder;
  EXPECT_EQ(FilesIn(folder.path()), 0U);
  std::ofstream(folder / "a") << "x";
  std::ofstream(folder / "b") << "x";
  EXPECT_EQ(FilesIn(folder.path()), 2U);
  EXPECT_EQ(FilesIn(folder / "none"), 0U);
}

}  // namespace
}  // namespace limbcast::process
