#include "services/fusion/filter_store.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "common/filters/filter_factory.hpp"
#include "tests/support/temporary_folder.hpp"

namespace limbcast::fusion {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

const Time kNow = TimeFromNanoseconds(1'700'000'000'000'000'000);

class FilterStoreTest : public ::testing::Test {
 protected:
  static std::shared_ptr<FilterSnapshot> SnapshotOf(std::vector<std::uint64_t> sensors) {
    auto snapshot = std::make_shared<FilterSnapshot>();
    const auto filter = filters::MakeFilter("tqt");
    for (const std::uint64_t sensor : sensors) {
      snapshot->Add(SensorUid{sensor}, **filter);
    }
    return snapshot;
  }
  [[nodiscard]] std::string File() const { return (folder_ / "filters.state").string(); }

  const test_support::TemporaryFolder folder_;
  const FilterStore store_{folder_.path(), 7};
  SavedFilters saved_;
};

TEST_F(FilterStoreTest, EachStateComesBackOnceAndWhole) {
  const std::vector snapshots = {SnapshotOf({1, 2}), SnapshotOf({}), SnapshotOf({3})};
  ASSERT_TRUE(store_.Save(snapshots, kNow).ok());
  ASSERT_TRUE(store_.Load(kNow + 10s, 1h, saved_).ok());
  EXPECT_EQ(saved_.size(), 3U);
  const auto filter = *filters::MakeFilter("tqt");
  for (const std::uint64_t sensor : {1U, 2U, 3U}) {
    const auto state = saved_.Take(SensorUid{sensor});
    EXPECT_TRUE(filter->RestoreState(state).ok()) << sensor;
    EXPECT_TRUE(saved_.Take(SensorUid{sensor}).empty()) << "given out before";
  }
  EXPECT_TRUE(saved_.Take(SensorUid{4}).empty());
}

TEST_F(FilterStoreTest, NothingWithoutFileOrFolderOfOtherSettingsOrTooOld) {
  EXPECT_TRUE(store_.Load(kNow, 1h, saved_).ok());
  const std::vector snapshots = {SnapshotOf({1})};
  ASSERT_TRUE(store_.Save(snapshots, kNow).ok());
  EXPECT_TRUE(store_.Load(kNow + 1h + 1ns, 1h, saved_).ok());
  EXPECT_TRUE(FilterStore(folder_.path(), 8).Load(kNow, 1h, saved_).ok());
  EXPECT_TRUE(FilterStore("", 7).Save(snapshots, kNow).ok());
  EXPECT_TRUE(FilterStore("", 7).Load(kNow, 1h, saved_).ok());
  EXPECT_EQ(saved_.size(), 0U);
  EXPECT_TRUE(store_.Load(kNow - 1h, 1h, saved_).ok()) << "the clock was set back";
  EXPECT_EQ(saved_.size(), 1U);
}

TEST_F(FilterStoreTest, WhateverIsCutOrAppendedIsRefusedAndKept) {
  const std::vector snapshots = {SnapshotOf({1, 2})};
  ASSERT_TRUE(store_.Save(snapshots, kNow).ok());
  std::ifstream in(File(), std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(in), {}};
  for (const std::size_t size : {std::size_t{0}, std::size_t{5}, std::size_t{32}, std::size_t{40},
                                 whole.size() / 2, whole.size() - 1, whole.size() + 1}) {
    std::string content = whole;
    content.resize(size, 'x');
    std::ofstream(File(), std::ios::binary) << content;
    const Status loaded = store_.Load(kNow, 1h, saved_);
    ASSERT_FALSE(loaded.ok()) << size;
    EXPECT_EQ(loaded.error().code, ErrorCode::kCorruptData);
    EXPECT_THAT(loaded.error().message, HasSubstr(File()));
    EXPECT_TRUE(std::filesystem::exists(File() + ".refused"));
    EXPECT_FALSE(std::filesystem::exists(File()));
  }
  std::string other = whole;
  other[8] = 9;  // version
  std::ofstream(File(), std::ios::binary) << other;
  EXPECT_THAT(store_.Load(kNow, 1h, saved_).error().message,
              HasSubstr("no filter states of this version"));
  EXPECT_EQ(saved_.size(), 0U);
}

TEST_F(FilterStoreTest, FileThatCannotBeWrittenIsNamedAndTheOldOneStays) {
  const std::vector snapshots = {SnapshotOf({1})};
  ASSERT_TRUE(store_.Save(snapshots, kNow).ok());
  std::filesystem::create_directory(File() + ".new");
  const Status written = store_.Save(snapshots, kNow + 1s);
  ASSERT_FALSE(written.ok());
  EXPECT_EQ(written.error().code, ErrorCode::kUnavailable);
  EXPECT_THAT(written.error().message, HasSubstr(File()));
  EXPECT_TRUE(store_.Load(kNow, 1h, saved_).ok());
  EXPECT_EQ(saved_.size(), 1U);
}

TEST_F(FilterStoreTest, FullDiskIsAnErrorAndTheOldFileStays) {
  if (!std::filesystem::exists("/dev/full")) {
    GTEST_SKIP() << "no /dev/full";
  }
  const std::vector snapshots = {SnapshotOf({1})};
  ASSERT_TRUE(store_.Save(snapshots, kNow).ok());
  std::filesystem::create_symlink("/dev/full", File() + ".new");
  const Status written = store_.Save(snapshots, kNow + 1s);
  ASSERT_FALSE(written.ok());
  EXPECT_THAT(written.error().message, HasSubstr("No space left on device"));
  EXPECT_TRUE(store_.Load(kNow, 1h, saved_).ok());
}

}  // namespace
}  // namespace limbcast::fusion
