#include "services/fusion/state_publisher.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "common/bus/inproc/inproc_bus.hpp"

namespace limbcast::fusion {
namespace {

using ::testing::ElementsAre;

class StatePublisherTest : public ::testing::Test {
 protected:
  void Open(bool frames) {
    writers_ = StateWriters::Make(*bus_, frames).value();
    publisher_ = std::make_unique<StatePublisher>(writers_, counters_);
  }

  void Write(std::uint32_t body_id, std::uint32_t sequence) {
    body::SegmentState state;
    state.body_id = BodyId{body_id};
    state.sequence = sequence;
    publisher_->Write(state);
  }

  FusionCounters Counted() const {
    FusionCounters sum;
    counters_.AddTo(sum);
    return sum;
  }

  std::shared_ptr<bus::inproc::Hub> hub_ = bus::inproc::MakeHub();
  std::unique_ptr<bus::Bus> bus_ = bus::inproc::MakeBus(hub_);
  std::unique_ptr<bus::Bus> outside_ = bus::inproc::MakeBus(hub_);
  std::vector<std::uint32_t> single_;               // sequence numbers
  std::vector<std::vector<std::uint32_t>> frames_;  // the same, by frame
  std::vector<std::uint32_t> frame_bodies_;
  std::vector<std::uint32_t> gone_;
  std::unique_ptr<bus::Reader<body::SegmentState>> single_reader_ =
      *outside_->MakeReader<body::SegmentState>(
          {.on_sample = [this](const body::SegmentState& state,
                               const bus::SampleInfo&) { single_.push_back(state.sequence); },
           .on_disposed = {}});
  std::unique_ptr<bus::Reader<body::SegmentFrame>> frame_reader_ =
      *outside_->MakeReader<body::SegmentFrame>(
          {.on_sample =
               [this](const body::SegmentFrame& frame, const bus::SampleInfo&) {
                 frame_bodies_.push_back(frame.body_id.value);
                 frames_.emplace_back();
                 for (const body::SegmentState& state : frame.states) {
                   EXPECT_EQ(state.body_id, frame.body_id);
                   frames_.back().push_back(state.sequence);
                 }
               },
           .on_disposed =
               [this](const body::SegmentFrame& key) { gone_.push_back(key.body_id.value); }});
  CounterCells counters_;
  StateWriters writers_;
  std::unique_ptr<StatePublisher> publisher_;
};

TEST_F(StatePublisherTest, AloneEachStateGoesOutAtOnce) {
  Open(false);
  Write(1, 10);
  Write(2, 11);
  EXPECT_THAT(single_, ElementsAre(10U, 11U));
  publisher_->Flush();
  EXPECT_TRUE(frames_.empty());
  EXPECT_EQ(Counted().published, 2U);
}

TEST_F(StatePublisherTest, AFrameHasTheStatesOfOneBodyInTheirOrder) {
  Open(true);
  Write(1, 10);
  Write(1, 11);
  EXPECT_TRUE(frames_.empty()) << "before it is flushed or another body comes";
  Write(2, 12);
  EXPECT_THAT(frames_, ElementsAre(ElementsAre(10U, 11U)));
  publisher_->Flush();
  EXPECT_THAT(frames_, ElementsAre(ElementsAre(10U, 11U), ElementsAre(12U)));
  EXPECT_THAT(frame_bodies_, ElementsAre(1U, 2U));
  publisher_->Flush();
  EXPECT_EQ(frames_.size(), 2U) << "nothing left to send";
  EXPECT_TRUE(single_.empty());
  EXPECT_EQ(Counted().published, 3U);
}

TEST_F(StatePublisherTest, AFullFrameMakesRoomForTheNext) {
  Open(true);
  for (std::uint32_t i = 0; i <= body::kMaxStatesPerFrame; ++i) {
    Write(1, i);
  }
  ASSERT_EQ(frames_.size(), 1U);
  EXPECT_EQ(frames_[0].size(), body::kMaxStatesPerFrame);
  publisher_->Flush();
  EXPECT_THAT(frames_[1], ElementsAre(std::uint32_t{body::kMaxStatesPerFrame}));
}

TEST_F(StatePublisherTest, ABodyThatIsGoneIsDisposedAfterItsLastStates) {
  Open(true);
  Write(1, 10);
  publisher_->DisposeBody(BodyId{1});
  EXPECT_THAT(frames_, ElementsAre(ElementsAre(10U)));
  EXPECT_THAT(gone_, ElementsAre(1U));
}

TEST_F(StatePublisherTest, AFrameThatCannotBeWrittenCountsEveryState) {
  Open(true);
  body::SegmentState state;
  state.filter = "a name too long to travel";
  publisher_->Write(state);
  publisher_->Write(state);
  publisher_->Flush();
  EXPECT_EQ(Counted().publish_errors, 2U);
  EXPECT_EQ(Counted().published, 0U);
}

}  // namespace
}  // namespace limbcast::fusion
