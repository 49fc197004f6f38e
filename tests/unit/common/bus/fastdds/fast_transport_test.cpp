#include "common/bus/fastdds/fast_transport.hpp"

#include <gtest/gtest.h>

#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/TransportReceiverInterface.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <cstdint>
#include <memory>
#include <vector>

namespace limbcast::bus::fastdds {
namespace {

using eprosima::fastdds::rtps::ChainingTransport;
using eprosima::fastdds::rtps::TransportInterface;
using eprosima::fastdds::rtps::UDPv4TransportDescriptor;
using eprosima::fastrtps::rtps::Locator_t;
using eprosima::fastrtps::rtps::octet;
using Bytes = std::vector<std::uint8_t>;

// What the library would get to read.
struct Library : eprosima::fastdds::rtps::TransportReceiverInterface {
  void OnDataReceived(const octet* data, const std::uint32_t size, const Locator_t& /*local*/,
                      const Locator_t& /*remote*/) override {
    messages.emplace_back(data, data + size);
  }
  std::vector<Bytes> messages;
};

// The head of a message with one fragment (DATA_FRAG, little endian, inline QoS) of `length` bytes.
Bytes FragmentHead(std::uint8_t length) {
  Bytes bytes = {'R', 'T', 'P', 'S', 2, 1, 1, 16};
  bytes.resize(20);
  bytes.insert(bytes.end(), {0x16, 3, length, 0, 0, 0, 28, 0});
  bytes.resize(bytes.size() + 28);
  return bytes;
}

class FastTransportTest : public ::testing::Test {
 protected:
  Bytes Received(Bytes bytes) {
    Library library;
    auto& chain = dynamic_cast<ChainingTransport&>(*transport_);
    chain.receive(&library, bytes.data(), static_cast<std::uint32_t>(bytes.size()), {}, {});
    return library.messages.empty() ? Bytes() : library.messages.front();
  }

  const std::unique_ptr<TransportInterface> transport_{
      WithoutKeysOfFragments(std::make_shared<UDPv4TransportDescriptor>())->create_transport()};
};

TEST_F(FastTransportTest, ItIsUdpWithTheLimitsOfUdp) {
  ASSERT_NE(transport_, nullptr);
  EXPECT_EQ(transport_->kind(), LOCATOR_KIND_UDPv4);
  EXPECT_EQ(transport_->get_configuration()->max_message_size(),
            UDPv4TransportDescriptor().max_message_size());
}

TEST_F(FastTransportTest, FragmentsComeWithoutTheirKeyHash) {
  Bytes bytes = FragmentHead(56);
  bytes.insert(bytes.end(), {0x70, 0, 16, 0});  // PID_KEY_HASH
  bytes.resize(bytes.size() + 16, 0xAA);
  bytes.insert(bytes.end(), {1, 0, 0, 0});  // PID_SENTINEL
  Bytes without = bytes;
  without[56] = 0;
  EXPECT_EQ(Received(bytes), without);
}

TEST_F(FastTransportTest, AFragmentWhoseParametersDoNotEndIsDropped) {
  Bytes bytes = FragmentHead(36);
  bytes.insert(bytes.end(), {0x71, 0, 4, 0});
  EXPECT_TRUE(Received(bytes).empty());
}

TEST_F(FastTransportTest, OtherMessagesPassAsTheyAre) {
  Bytes bytes = FragmentHead(32);
  bytes[20] = 0x15;  // DATA
  EXPECT_EQ(Received(bytes), bytes);
}

}  // namespace
}  // namespace limbcast::bus::fastdds
