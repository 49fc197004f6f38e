#include "tests/unit/common/bus/wire/codec_properties.hpp"

namespace limbcast::bus::testing {
namespace {

using SegmentTopics = ::testing::Types<body::SegmentState, body::SegmentFrame, body::SegmentTruth>;
INSTANTIATE_TYPED_TEST_SUITE_P(Segment, CodecTest, SegmentTopics);

TEST(SegmentCodecTest, AFilterNameOf17CharactersIsRefused) {
  ExpectOutOfBounds(body::SegmentState{.filter = std::string(17, 'f')},
                    "segment_state.filter has 17 characters, at most 16 are allowed");
}

TEST(SegmentCodecTest, NumbersThatAreNoEnumeratorsAreRefused) {
  wire::SegmentState received;
  received.segment(23);
  ExpectCorrupt<body::SegmentState>(
      received, "segment_state.segment has 23 as its number, at most 22 are allowed");
  received.segment(22);
  received.verdict(11);
  ExpectCorrupt<body::SegmentState>(
      received, "segment_state.verdict has 11 as its number, at most 10 are allowed");
  received.verdict(10);
  received.magnetic_state(3);
  ExpectCorrupt<body::SegmentState>(
      received, "segment_state.magnetic_state has 3 as its number, at most 2 are allowed");
  received.magnetic_state(2);
  received.position_reference(2);
  ExpectCorrupt<body::SegmentState>(
      received, "segment_state.position_reference has 2 as its number, at most 1 are allowed");
}

TEST(SegmentCodecTest, AFrameWithOneWrongStateIsRefused) {
  body::SegmentFrame frame;
  frame.states.resize(body::kMaxStatesPerFrame + 1);
  ExpectOutOfBounds(frame, "segment_frame.states has 65 elements, at most 64 are allowed");
  wire::SegmentFrame received;
  received.states().resize(2);
  received.states()[1].segment(23);
  ExpectCorrupt<body::SegmentFrame>(
      received, "segment_frame.segment has 23 as its number, at most 22 are allowed");
}

TEST(SegmentCodecTest, SlotsOfOneSegmentAreDifferentInstances) {
  const body::SegmentState used{.body_id = {7}, .segment = body::Segment::kHead, .slot = 0};
  const body::SegmentState beside{.body_id = {7}, .segment = body::Segment::kHead, .slot = 1};
  EXPECT_NE(Codec<body::SegmentState>::Key(used), Codec<body::SegmentState>::Key(beside));
}

}  // namespace
}  // namespace limbcast::bus::testing
