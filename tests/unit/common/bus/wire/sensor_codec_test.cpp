#include "tests/unit/common/bus/wire/codec_properties.hpp"

namespace limbcast::bus::testing {
namespace {

using SensorTopics =
    ::testing::Types<sensing::MargSample, sensing::MargFrame, sensing::FusedOrientation,
                     sensing::CoilBurst, sensing::MarkerPosition, sensing::PositionFix,
                     sensing::SensorInfo>;
INSTANTIATE_TYPED_TEST_SUITE_P(Sensor, CodecTest, SensorTopics);

TEST(SensorCodecTest, TextsBeyondTheirBoundsAreRefusedByName) {
  ExpectOutOfBounds(sensing::SensorInfo{.driver = std::string(33, 'x')},
                    "sensor_info.driver has 33 characters, at most 32 are allowed");
  ExpectOutOfBounds(sensing::SensorInfo{.calibration = std::string(65, 'x')},
                    "sensor_info.calibration has 65 characters, at most 64 are allowed");
  ExpectOutOfBounds(sensing::SensorInfo{.serial = std::string("a\0b", 3)},
                    "sensor_info.serial has 1 NUL characters, at most 0 are allowed");
}

TEST(SensorCodecTest, AFrameOf65SamplesIsRefusedInBothDirections) {
  sensing::MargFrame frame;
  frame.samples.resize(65);
  ExpectOutOfBounds(frame, "marg_frame.samples has 65 elements, at most 64 are allowed");
  wire::MargFrame received;
  received.samples().resize(65);
  ExpectCorrupt<sensing::MargFrame>(received,
                                    "marg_frame.samples has 65 elements, at most 64 are allowed");
}

TEST(SensorCodecTest, ANumberThatIsNoEnumeratorIsRefused) {
  wire::FusedOrientation received;
  received.heading(3);
  ExpectCorrupt<sensing::FusedOrientation>(
      received, "orientation.heading has 3 as its number, at most 2 are allowed");
}

TEST(SensorCodecTest, ATextLongerThanItsBoundOnTheWireIsRefusedNotCut) {
  // The generated reader would cut it: a peer with a wider bound must not pass for one of ours.
  sensing::SensorInfo value{.driver = std::string(32, 'x'), .serial = "s"};
  wire::SensorInfo wire;
  ASSERT_TRUE(Codec<sensing::SensorInfo>::Encode(value, wire));
  std::vector<char> bytes(Codec<sensing::SensorInfo>::SerializedSize(wire));
  ASSERT_EQ(Codec<sensing::SensorInfo>::Serialize(wire, bytes), bytes.size());
  ASSERT_TRUE(Codec<sensing::SensorInfo>::Deserialize(bytes, wire));

  const std::size_t length_at = 4 + 8;  // header, sensor_uid
  ASSERT_EQ(bytes[length_at], 33);      // with its NUL
  bytes.insert(bytes.begin() + length_at + 4 + 32, 4, 'x');
  bytes[length_at] = 37;
  EXPECT_FALSE(Codec<sensing::SensorInfo>::Deserialize(bytes, wire));
}

TEST(SensorCodecTest, BothByteOrdersAreRead) {
  // MargSample in big-endian CDR, written by hand: uid 0x0102030405060708, sample 9.
  std::vector<char> bytes = {0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 0, 0, 0, 9};
  bytes.resize(4 + 8 + 4 + 4 + 8 + 8 + 9 * 4 + 4);
  wire::MargSample wire;
  ASSERT_TRUE(Codec<sensing::MargSample>::Deserialize(bytes, wire));
  EXPECT_EQ(wire.sensor_uid(), 0x0102030405060708U);
  EXPECT_EQ(wire.sample_number(), 9U);
}

TEST(SensorCodecTest, AMargSampleIsAsSmallAsItsFields) {
  EXPECT_EQ(wire::MargSample::getMaxCdrSerializedSize(), 72U);
}

}  // namespace
}  // namespace limbcast::bus::testing
