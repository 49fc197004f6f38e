#include "services/gateway/ack_window.hpp"

#include <gtest/gtest.h>

namespace limbcast::gateway {
namespace {

using namespace std::chrono_literals;

constexpr Time kNow = TimeFromNanoseconds(1'000'000'000);

TEST(AckWindowTest, FullWhenOneLaneHoldsItsDepth) {
  AckWindow window(2, 1s, AckWindow::Older::kLost);
  const std::size_t a = window.AddLane(true);
  const std::size_t b = window.AddLane(true);
  window.Sent(a, 1, kNow);
  window.Sent(b, 1, kNow);
  EXPECT_FALSE(window.full());
  window.Sent(a, 2, kNow);
  EXPECT_TRUE(window.full());
  EXPECT_TRUE(window.Answered(a, 1));
  EXPECT_FALSE(window.full());
  EXPECT_TRUE(window.Answered(a, 2));
  EXPECT_TRUE(window.Answered(b, 1));
  EXPECT_TRUE(window.empty());
  EXPECT_EQ(window.lost(), 0U);
}

TEST(AckWindowTest, AnAnswerBeyondATokenMeansThatThisOneIsLost) {
  AckWindow window(4, 1s, AckWindow::Older::kLost);
  const std::size_t lane = window.AddLane(true);
  for (const int token : {1, 2, 3}) {
    window.Sent(lane, token, kNow);
  }
  EXPECT_TRUE(window.Answered(lane, 3));
  EXPECT_EQ(window.lost(lane), 2U);
  EXPECT_TRUE(window.empty());
}

TEST(AckWindowTest, OneAnswerMayStandForSeveral) {
  AckWindow window(4, 1s, AckWindow::Older::kAnswered);
  const std::size_t lane = window.AddLane(true);
  for (const int token : {10, 20, 30}) {
    window.Sent(lane, token, kNow);
  }
  window.Answered(lane, 25);
  EXPECT_FALSE(window.empty());
  window.Answered(lane, 30);
  EXPECT_TRUE(window.empty());
  EXPECT_EQ(window.lost(), 0U);
}

TEST(AckWindowTest, DeadlineCountsAsLostAndSilencesTheLane) {
  AckWindow window(2, 1s, AckWindow::Older::kLost);
  const std::size_t lane = window.AddLane(true);
  window.Sent(lane, 1, kNow);
  window.Sent(lane, 2, kNow + 100ms);
  EXPECT_EQ(window.NextDeadline(), kNow + 1s);
  EXPECT_EQ(window.Expire(kNow + 999ms), 0U);
  EXPECT_EQ(window.Expire(kNow + 1s), 2U);
  EXPECT_TRUE(window.silent());
  EXPECT_FALSE(window.full());
  window.Sent(lane, 3, kNow + 2s);  // lost at once, holds nobody up
  EXPECT_EQ(window.lost(), 3U);
  EXPECT_TRUE(window.empty());
}

TEST(AckWindowTest, SilentLaneThatAnswersIsFollowedAgain) {
  AckWindow window(2, 1s, AckWindow::Older::kLost);
  const std::size_t lane = window.AddLane(true);
  window.Sent(lane, 1, kNow);
  window.Expire(kNow + 1s);
  window.Sent(lane, 2, kNow + 2s);
  EXPECT_TRUE(window.Answered(lane, 2));  // was counted lost too early
  EXPECT_EQ(window.lost(), 1U);
  EXPECT_FALSE(window.silent());
  window.Sent(lane, 3, kNow + 3s);
  EXPECT_FALSE(window.empty());
}

TEST(AckWindowTest, LateAndDoubleAnswersAreCountedApart) {
  AckWindow window(2, 1s, AckWindow::Older::kLost);
  const std::size_t lane = window.AddLane(true);
  window.Sent(lane, 1, kNow);
  EXPECT_TRUE(window.Answered(lane, 1));
  EXPECT_FALSE(window.Answered(lane, 1));
  EXPECT_EQ(window.late(), 1U);
  EXPECT_EQ(window.lost(), 0U);
}

TEST(AckWindowTest, LaneThatIsNotExpectedToAnswerHoldsNobodyUp) {
  AckWindow window(1, 1s, AckWindow::Older::kLost);
  const std::size_t lane = window.AddLane(false);
  window.Sent(lane, 1, kNow);
  EXPECT_FALSE(window.full());
  EXPECT_EQ(window.lost(), 0U);
  window.Heard(lane);
  window.Sent(lane, 2, kNow);
  EXPECT_TRUE(window.full());
}

TEST(AckWindowTest, SentOnAFullLaneGivesTheOldestUp) {
  AckWindow window(2, 1s, AckWindow::Older::kLost);
  const std::size_t lane = window.AddLane(true);
  for (const int token : {1, 2, 3}) {
    window.Sent(lane, token, kNow);
  }
  EXPECT_EQ(window.lost(), 1U);
  EXPECT_TRUE(window.full());
}

TEST(AckWindowTest, SilenceGivesEverythingUp) {
  AckWindow window(2, 1s, AckWindow::Older::kLost);
  window.Sent(window.AddLane(true), 1, kNow);
  window.Silence();
  EXPECT_TRUE(window.silent());
  EXPECT_TRUE(window.empty());
  EXPECT_EQ(window.lost(), 1U);
}

}  // namespace
}  // namespace limbcast::gateway
