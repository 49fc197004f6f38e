#include "services/posture/tick_assembler.hpp"

#include <gtest/gtest.h>

namespace limbcast::posture {
namespace {

using body::Segment;
using Place = TickAssembler::Place;
using namespace std::chrono_literals;

constexpr Time kStart = TimeFromNanoseconds(1'700'000'000'000'000'000);
constexpr SegmentSet kBoth = BitOf(Segment::kPelvis) | BitOf(Segment::kHead);

class TickAssemblerTest : public ::testing::Test {
 protected:
  TickAssemblerTest() { tick_.Expect(kBoth); }
  void Full(Time at) {
    tick_.Add(Segment::kPelvis, at, true, at);
    tick_.Add(Segment::kHead, at, true, at);
    EXPECT_TRUE(tick_.full());
    tick_.Close();
  }
  TickAssembler tick_{{.deadline = 8ms, .missing_after = 2s}};
};

TEST_F(TickAssemblerTest, IsFullWhenEveryExpectedSegmentWasHeard) {
  EXPECT_FALSE(tick_.full());
  EXPECT_EQ(tick_.Classify(Segment::kPelvis, kStart), Place::kHere);
  tick_.Add(Segment::kPelvis, kStart, true, kStart + 5ms);
  EXPECT_FALSE(tick_.full());
  EXPECT_EQ(tick_.deadline(), kStart + 13ms) << "from the arrival, not from the measurement";
  tick_.Add(Segment::kHead, kStart + 1ms, true, kStart + 6ms);
  EXPECT_TRUE(tick_.full());
  EXPECT_EQ(tick_.measured_at(), kStart + 1ms) << "the newest";
  EXPECT_EQ(tick_.measured(), kBoth);
  tick_.Close();
  EXPECT_FALSE(tick_.deadline().has_value());
}

TEST_F(TickAssemblerTest, TellsLateOldAndNextApart) {
  Full(kStart);
  EXPECT_EQ(tick_.Classify(Segment::kHead, kStart), Place::kOld);
  tick_.Add(Segment::kPelvis, kStart + 10ms, true, kStart);
  EXPECT_EQ(tick_.Classify(Segment::kPelvis, kStart + 20ms), Place::kNext);
  EXPECT_EQ(tick_.Classify(Segment::kHead, kStart + 10ms), Place::kHere);
  tick_.Close();
  EXPECT_EQ(tick_.Classify(Segment::kHead, kStart + 10ms), Place::kLate);
  tick_.AddLate(Segment::kHead, kStart + 10ms);
  EXPECT_EQ(tick_.Classify(Segment::kHead, kStart + 10ms), Place::kOld);
  EXPECT_EQ(tick_.Classify(Segment::kHead, kStart - 991ms), Place::kNewStart);
  EXPECT_EQ(tick_.Classify(Segment::kHead, kStart - 990ms), Place::kOld);
}

TEST_F(TickAssemblerTest, ASilentSegmentIsNotWaitedForAfterMissingAfter) {
  Full(kStart);
  tick_.Add(Segment::kPelvis, kStart + 2s, true, kStart);
  EXPECT_FALSE(tick_.full());
  EXPECT_EQ(tick_.missing(kStart + 2s), 0U);
  tick_.Close();
  tick_.Add(Segment::kPelvis, kStart + 2s + 1ns, true, kStart);
  EXPECT_TRUE(tick_.full());
  EXPECT_EQ(tick_.missing(kStart + 2s + 1ns), BitOf(Segment::kHead));
}

TEST_F(TickAssemblerTest, ASegmentNeverHeardIsMissingAtOnceButWaitedForAtFirst) {
  tick_.Add(Segment::kPelvis, kStart, true, kStart);
  EXPECT_EQ(tick_.missing(kStart), BitOf(Segment::kHead));
  EXPECT_FALSE(tick_.full());
  tick_.Close();
  tick_.Add(Segment::kPelvis, kStart + 2s + 1ms, true, kStart);
  EXPECT_TRUE(tick_.full());
}

TEST_F(TickAssemblerTest, AnAnswerWithoutOrientationFillsTheTickButIsNoMeasurement) {
  tick_.Add(Segment::kPelvis, kStart, true, kStart);
  tick_.Add(Segment::kHead, kStart, false, kStart);
  EXPECT_TRUE(tick_.full());
  EXPECT_EQ(tick_.measured(), BitOf(Segment::kPelvis));
}

TEST_F(TickAssemblerTest, ForgetsSegmentsThatAreNoLongerExpected) {
  tick_.Add(Segment::kPelvis, kStart, true, kStart);
  tick_.Expect(BitOf(Segment::kPelvis));
  EXPECT_TRUE(tick_.full());
  EXPECT_EQ(tick_.missing(kStart), 0U);
}

TEST_F(TickAssemblerTest, RestartForgetsTheTimes) {
  Full(kStart);
  tick_.Restart();
  EXPECT_EQ(tick_.Classify(Segment::kHead, kStart - 1h), Place::kHere);
}

}  // namespace
}  // namespace limbcast::posture
