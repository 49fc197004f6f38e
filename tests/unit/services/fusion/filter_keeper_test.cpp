#include "services/fusion/filter_keeper.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "common/filters/filter_factory.hpp"
#include "tests/support/fake_clock.hpp"
#include "tests/support/temporary_folder.hpp"

namespace limbcast::fusion {
namespace {

class FilterKeeperTest : public ::testing::Test {
 protected:
  // As a worker does it.
  static void Answer(FilterSnapshot& snapshot, std::uint64_t sensor) {
    snapshot.Add(SensorUid{sensor}, **filters::MakeFilter("tqt"));
    snapshot.complete = true;
  }
  [[nodiscard]] std::size_t InFile() const {
    SavedFilters saved;
    EXPECT_TRUE(store_.Load(clock_.Now(), std::chrono::hours(1), saved).ok());
    return saved.size();
  }

  const test_support::TemporaryFolder folder_;
  const test_support::FakeClock clock_;
  const FilterStore store_{folder_.path(), 7};
  std::vector<std::pair<std::size_t, std::shared_ptr<FilterSnapshot>>> asked_;
  bool room_ = true;
  int told_ = 0;
  FilterKeeper keeper_{store_, clock_, 2,
                       [this](std::size_t worker, std::shared_ptr<FilterSnapshot> snapshot) {
                         asked_.emplace_back(worker, std::move(snapshot));
                         return room_ || worker == 0;
                       },
                       [this](const Status& written) { told_ += written ? 1 : 0; }};
};

TEST_F(FilterKeeperTest, WritesWhenAllHaveAnsweredAndAsksAgain) {
  keeper_.Tick();
  ASSERT_EQ(asked_.size(), 2U);
  Answer(*asked_[0].second, 1);
  keeper_.Tick();
  EXPECT_EQ(asked_.size(), 2U) << "one has not answered";
  EXPECT_EQ(keeper_.saved(), 0U);
  Answer(*asked_[1].second, 2);
  keeper_.Tick();
  EXPECT_EQ(keeper_.saved(), 1U);
  EXPECT_EQ(told_, 1);
  EXPECT_EQ(InFile(), 2U);
  EXPECT_EQ(asked_.size(), 4U);
}

TEST_F(FilterKeeperTest, AnswerToAQuestionThatNotAllHeardIsDropped) {
  room_ = false;
  keeper_.Tick();
  ASSERT_EQ(asked_.size(), 2U);
  room_ = true;
  keeper_.Tick();
  ASSERT_EQ(asked_.size(), 4U);
  Answer(*asked_[0].second, 1);  // late
  Answer(*asked_[2].second, 3);
  keeper_.Tick();
  EXPECT_EQ(keeper_.saved(), 0U);
  Answer(*asked_[3].second, 4);
  keeper_.Tick();
  EXPECT_EQ(keeper_.saved(), 1U);
  EXPECT_EQ(InFile(), 2U);
}

TEST_F(FilterKeeperTest, FailureIsCounted) {
  std::filesystem::remove_all(folder_.path());
  auto snapshot = std::make_shared<FilterSnapshot>();
  Answer(*snapshot, 1);
  keeper_.SaveNow({snapshot});
  EXPECT_EQ(keeper_.errors(), 1U);
  EXPECT_EQ(keeper_.saved(), 0U);
  EXPECT_EQ(told_, 0);
}

}  // namespace
}  // namespace limbcast::fusion
