#include "common/bus/wire/rtps_fragments.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace limbcast::bus::testing {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint16_t kKeyHash = 0x0070;
constexpr std::uint16_t kPad = 0x0000;
constexpr std::uint16_t kSentinel = 0x0001;
constexpr std::uint16_t kStatusInfo = 0x0071;

/// Writes DDSI-RTPS 2.2, 9.4, in the byte order of the test.
class Message {
 public:
  explicit Message(bool little_endian) : little_endian_(little_endian) {
    bytes_ = {'R', 'T', 'P', 'S', 2, 2, 1, 16};
    bytes_.resize(20, 0xAB);
  }

  Message& Add(std::uint8_t kind, std::uint8_t flags, const Bytes& body, bool last = false) {
    bytes_.push_back(kind);
    bytes_.push_back(static_cast<std::uint8_t>(flags | (little_endian_ ? 1U : 0U)));
    Put(bytes_, last ? 0 : static_cast<std::uint16_t>(body.size()));
    bytes_.insert(bytes_.end(), body.begin(), body.end());
    return *this;
  }

  /// A fragment with these parameters, `extra` bytes before them.
  [[nodiscard]] Bytes Fragment(const std::vector<std::pair<std::uint16_t, std::uint16_t>>& list,
                               std::uint16_t extra = 0) const {
    Bytes body = {0, 0};
    Put(body, static_cast<std::uint16_t>(28 + extra));
    body.resize(body.size() + 28U + extra, 0xCD);
    for (const auto& [parameter, length] : list) {
      Put(body, parameter);
      Put(body, length);
      body.resize(body.size() + length, 0x70);
    }
    body.resize(body.size() + 8, 0);  // the piece of the sample
    return body;
  }

  [[nodiscard]] const Bytes& bytes() const { return bytes_; }

 private:
  void Put(Bytes& bytes, std::uint16_t value) const {
    const auto high = static_cast<std::uint8_t>(value >> 8U);
    const auto low = static_cast<std::uint8_t>(value);
    bytes.push_back(little_endian_ ? low : high);
    bytes.push_back(little_endian_ ? high : low);
  }

  bool little_endian_;
  Bytes bytes_;
};

constexpr std::uint8_t kInfoTimestamp = 0x09;
constexpr std::uint8_t kData = 0x15;
constexpr std::uint8_t kDataFragment = 0x16;
constexpr std::uint8_t kInlineQos = 0x02;

class RtpsFragmentsTest : public ::testing::TestWithParam<bool> {};

TEST_P(RtpsFragmentsTest, TheKeyOfAFragmentIsPaddingAndNothingElseChanges) {
  const auto message = [](std::uint16_t parameter) {
    Message written(GetParam());
    written.Add(kInfoTimestamp, 0, Bytes(8, 1));
    written.Add(kDataFragment, kInlineQos,
                written.Fragment({{kStatusInfo, 4}, {parameter, 16}, {kSentinel, 0}}));
    return written.bytes();
  };
  Bytes bytes = message(kKeyHash);
  EXPECT_TRUE(ForgetKeysOfFragments(bytes));
  EXPECT_EQ(bytes, message(kPad));
}

TEST_P(RtpsFragmentsTest, EveryFragmentOfAMessage) {
  const auto message = [](std::uint16_t parameter) {
    Message written(GetParam());
    const Bytes fragment = written.Fragment({{parameter, 16}, {kSentinel, 0}});
    written.Add(kInfoTimestamp, 2, {});  // "no time": empty, and not the last one
    written.Add(kDataFragment, kInlineQos, fragment);
    written.Add(kDataFragment, kInlineQos,
                written.Fragment({{parameter, 16}, {parameter, 16}, {kSentinel, 0}}, 12));
    written.Add(kDataFragment, kInlineQos, fragment, true);
    return written.bytes();
  };
  Bytes bytes = message(kKeyHash);
  EXPECT_TRUE(ForgetKeysOfFragments(bytes));
  EXPECT_EQ(bytes, message(kPad));
}

TEST_P(RtpsFragmentsTest, WholeSamplesKeepTheirKeys) {
  Message message(GetParam());
  message.Add(kData, kInlineQos, message.Fragment({{kKeyHash, 16}, {kSentinel, 0}}));
  message.Add(kDataFragment, 0, message.Fragment({{kKeyHash, 16}, {kSentinel, 0}}));  // no QoS
  message.Add(kDataFragment, kInlineQos, message.Fragment({{kSentinel, 0}, {kKeyHash, 16}}));
  Bytes bytes = message.bytes();
  EXPECT_TRUE(ForgetKeysOfFragments(bytes));
  EXPECT_EQ(bytes, message.bytes());
}

TEST_P(RtpsFragmentsTest, LessThanTheLibrarySkipsIsNotBelieved) {
  // Fast DDS reads the parameters 28 bytes on even when the message says they come earlier.
  const auto message = [](std::uint16_t parameter) {
    Message written(GetParam());
    Bytes body = written.Fragment({{parameter, 16}, {kSentinel, 0}});
    body[2] = body[3] = 0;
    return written.Add(kDataFragment, kInlineQos, body).bytes();
  };
  Bytes bytes = message(kKeyHash);
  EXPECT_TRUE(ForgetKeysOfFragments(bytes));
  EXPECT_EQ(bytes, message(kPad));
}

TEST_P(RtpsFragmentsTest, ParametersThatRunPastTheirFragmentGoNoFurther) {
  for (const std::uint16_t length : {std::uint16_t{24}, std::uint16_t{0xFFFF}}) {
    Message message(GetParam());
    Bytes body = message.Fragment({{kStatusInfo, 4}});
    body.resize(4 + 28 + 4);  // the header of the parameter, and no more
    body[GetParam() ? 34 : 35] = static_cast<std::uint8_t>(length);
    body[GetParam() ? 35 : 34] = static_cast<std::uint8_t>(length >> 8U);
    message.Add(kDataFragment, kInlineQos, body);
    message.Add(kData, kInlineQos, message.Fragment({{kKeyHash, 16}, {kSentinel, 0}}));
    Bytes bytes = message.bytes();
    EXPECT_FALSE(ForgetKeysOfFragments(bytes)) << length;
  }
  Message message(GetParam());
  message.Add(kDataFragment, kInlineQos, {0, 0});
  Bytes bytes = message.bytes();
  EXPECT_FALSE(ForgetKeysOfFragments(bytes));
}

TEST_P(RtpsFragmentsTest, OnceIsEnoughForAnyBytes) {
  Message message(GetParam());
  message.Add(kDataFragment, kInlineQos, message.Fragment({{kKeyHash, 16}, {kSentinel, 0}}));
  for (std::size_t size = 0; size < message.bytes().size(); ++size) {
    Bytes cut(message.bytes().begin(), message.bytes().begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_TRUE(ForgetKeysOfFragments(cut)) << size;  // which the library does not read
  }
  message.Add(kDataFragment, kInlineQos, message.Fragment({{kKeyHash, 16}, {kSentinel, 0}}));
  std::mt19937 rng(20261127);
  int passed = 0;
  for (int i = 0; i < 20000; ++i) {
    Bytes noise = message.bytes();
    for (int changed = 0; changed < 6; ++changed) {
      noise[4 + (rng() % (noise.size() - 4))] = static_cast<std::uint8_t>(rng());
    }
    if (ForgetKeysOfFragments(noise)) {
      ++passed;
      const Bytes once = noise;
      EXPECT_TRUE(ForgetKeysOfFragments(noise)) << i;
      EXPECT_EQ(noise, once) << i;
    }
  }
  EXPECT_GT(passed, 1000);
  EXPECT_LT(passed, 20000);
}

TEST(RtpsFragmentsOtherTest, WhatIsNoRtpsMessageStaysAsItIs) {
  Message message(true);
  message.Add(kDataFragment, kInlineQos, message.Fragment({{kKeyHash, 16}, {kSentinel, 0}}));
  Bytes bytes = message.bytes();
  bytes[0] = 'X';
  const Bytes before = bytes;
  EXPECT_TRUE(ForgetKeysOfFragments(bytes));
  EXPECT_EQ(bytes, before);
  EXPECT_TRUE(ForgetKeysOfFragments({}));
}

INSTANTIATE_TEST_SUITE_P(ByteOrder, RtpsFragmentsTest, ::testing::Bool(), [](const auto& test) {
  return std::string(test.param ? "little" : "big");
});

}  // namespace
}  // namespace limbcast::bus::testing
