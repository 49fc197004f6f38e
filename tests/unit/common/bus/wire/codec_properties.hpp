#pragma once

// What holds for the codec of every topic; each <room>_codec_test.cpp instantiates it.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <span>
#include <vector>

#include "common/bus/wire/codec.hpp"
#include "common/bus/wire/wire_types.hpp"
#include "tests/unit/common/bus/random_values.hpp"

namespace limbcast::bus::testing {

template <typename T>
class CodecTest : public ::testing::Test {
 protected:
  using C = Codec<T>;
  using Wire = typename C::Wire;

  std::vector<char> Bytes(const T& value) {
    Wire wire;
    EXPECT_TRUE(C::Encode(value, wire));
    std::vector<char> bytes(C::SerializedSize(wire));
    EXPECT_EQ(C::Serialize(wire, bytes), bytes.size());
    return bytes;
  }
  std::mt19937_64 rng{20240517};  // fixed seed: a failure must repeat
};
TYPED_TEST_SUITE_P(CodecTest);

TYPED_TEST_P(CodecTest, RoundTripKeepsEveryField) {
  typename TestFixture::Wire wire;  // reused, as by the back ends
  typename TestFixture::Wire received;
  TypeParam decoded;
  for (int trial = 0; trial < 200; ++trial) {
    const auto value = RandomValue<TypeParam>(this->rng);
    ASSERT_TRUE(Codec<TypeParam>::CheckBounds(value));
    ASSERT_TRUE(Codec<TypeParam>::Encode(value, wire));
    std::vector<char> bytes(Codec<TypeParam>::SerializedSize(wire));
    ASSERT_EQ(Codec<TypeParam>::Serialize(wire, bytes), bytes.size());
    ASSERT_TRUE(Codec<TypeParam>::Deserialize(bytes, received));
    ASSERT_TRUE(Codec<TypeParam>::Decode(received, decoded));
    EXPECT_TRUE(Equal(value, decoded)) << "trial " << trial;
  }
}

TYPED_TEST_P(CodecTest, EveryTruncationIsRefused) {
  const std::vector<char> bytes = this->Bytes(RandomValue<TypeParam>(this->rng));
  typename TestFixture::Wire wire;
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    // A copy of its own, so that a sanitizer sees reads beyond the end.
    const std::vector<char> part(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(Codec<TypeParam>::Deserialize(part, wire)) << size << " of " << bytes.size();
  }
}

TYPED_TEST_P(CodecTest, TrailingBytesBeyondPaddingAreRefused) {
  std::vector<char> bytes = this->Bytes(RandomValue<TypeParam>(this->rng));
  typename TestFixture::Wire wire;
  bytes.resize(bytes.size() + 3);
  EXPECT_TRUE(Codec<TypeParam>::Deserialize(bytes, wire));
  bytes.resize(bytes.size() + 1);
  EXPECT_FALSE(Codec<TypeParam>::Deserialize(bytes, wire));
}

TYPED_TEST_P(CodecTest, OtherRepresentationsAreRefused) {
  std::vector<char> bytes = this->Bytes(RandomValue<TypeParam>(this->rng));
  typename TestFixture::Wire wire;
  for (const int representation : {2, 3, 6, 7, 8, 9, 10, 11}) {  // PL_CDR, XCDR2
    bytes[1] = static_cast<char>(representation);
    EXPECT_FALSE(Codec<TypeParam>::Deserialize(bytes, wire)) << representation;
  }
  bytes[1] = 1;
  bytes[0] = 1;
  EXPECT_FALSE(Codec<TypeParam>::Deserialize(bytes, wire));
}

TYPED_TEST_P(CodecTest, RandomBytesNeverCrash) {
  typename TestFixture::Wire wire;
  TypeParam value;
  int accepted = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<char> bytes(4 + this->rng() % 600);
    std::generate(bytes.begin(), bytes.end(), [this] { return static_cast<char>(this->rng()); });
    bytes[0] = 0;
    bytes[1] = static_cast<char>(this->rng() % 2);
    if (Codec<TypeParam>::Deserialize(bytes, wire) && Codec<TypeParam>::Decode(wire, value)) {
      ++accepted;
      EXPECT_TRUE(Codec<TypeParam>::CheckBounds(value));  // what is accepted can be sent on
    }
  }
  EXPECT_LT(accepted, 100);  // of a fixed size that has no enum, one size in 150 fits
}

TYPED_TEST_P(CodecTest, FlippedBitsNeverCrashAndWhatIsAcceptedIsInBounds) {
  const std::vector<char> good = this->Bytes(RandomValue<TypeParam>(this->rng));
  typename TestFixture::Wire wire;
  TypeParam value;
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<char> bytes = good;
    const std::size_t bit = 32 + this->rng() % (8 * (bytes.size() - 4));
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << (bit % 8)));
    if (Codec<TypeParam>::Deserialize(bytes, wire) && Codec<TypeParam>::Decode(wire, value)) {
      EXPECT_TRUE(Codec<TypeParam>::CheckBounds(value));
    }
  }
}

TYPED_TEST_P(CodecTest, KeyIsShortComesFirstAndSurvivesEveryForm) {
  using Coder = Codec<TypeParam>;
  const auto value = RandomValue<TypeParam>(this->rng);
  typename TestFixture::Wire wire;
  ASSERT_TRUE(Coder::Encode(value, wire));
  EXPECT_TRUE(TestFixture::Wire::isKeyDefined());
  EXPECT_LE(TestFixture::Wire::getKeyMaxCdrSerializedSize(), 16U);

  const auto key_of = [](const typename TestFixture::Wire& from) {
    TypeParam key;
    EXPECT_TRUE(Coder::DecodeKey(from, key));
    return Coder::Key(key);
  };
  typename TestFixture::Wire other;
  std::array<char, 24> cdr{};
  const std::size_t size = Coder::SerializeKey(wire, cdr);
  ASSERT_GT(size, 4U);
  ASSERT_TRUE(Coder::DeserializeKey(std::span(cdr).first(size), other));
  EXPECT_EQ(key_of(other), Coder::Key(value));

  typename TestFixture::Wire from_hash;
  Coder::FromKeyHash(Coder::HashKey(wire), from_hash);
  EXPECT_EQ(key_of(from_hash), Coder::Key(value));

  typename TestFixture::Wire leading;
  ASSERT_TRUE(Coder::DeserializeLeadingKey(this->Bytes(value), leading));
  EXPECT_EQ(key_of(leading), Coder::Key(value));

  typename TestFixture::Wire encoded;
  Coder::EncodeKey(value, encoded);
  EXPECT_EQ(key_of(encoded), Coder::Key(value));
  typename TestFixture::Wire copied;
  Coder::CopyKey(wire, copied);
  EXPECT_EQ(Coder::HashKey(copied), Coder::HashKey(wire));
  EXPECT_NE(Coder::Key(value), Coder::Key(RandomValue<TypeParam>(this->rng)));
}

REGISTER_TYPED_TEST_SUITE_P(CodecTest, RoundTripKeepsEveryField, EveryTruncationIsRefused,
                            TrailingBytesBeyondPaddingAreRefused, OtherRepresentationsAreRefused,
                            RandomBytesNeverCrash, FlippedBitsNeverCrashAndWhatIsAcceptedIsInBounds,
                            KeyIsShortComesFirstAndSurvivesEveryForm);

/// Encode and CheckBounds refuse `value` with exactly this message.
template <typename T>
void ExpectOutOfBounds(const T& value, const std::string& message) {
  typename Codec<T>::Wire wire;
  const Status encoded = Codec<T>::Encode(value, wire);
  ASSERT_FALSE(encoded);
  EXPECT_EQ(encoded.error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(encoded.error().message, message);
  const Status checked = Codec<T>::CheckBounds(value);
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().message, message);
}

/// Decode refuses `wire` with exactly this message.
template <typename T>
void ExpectCorrupt(const typename Codec<T>::Wire& wire, const std::string& message) {
  T value;
  const Status decoded = Codec<T>::Decode(wire, value);
  ASSERT_FALSE(decoded);
  EXPECT_EQ(decoded.error().code, ErrorCode::kCorruptData);
  EXPECT_EQ(decoded.error().message, message);
}

}  // namespace limbcast::bus::testing
