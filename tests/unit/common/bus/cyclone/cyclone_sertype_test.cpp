#include "common/bus/cyclone/cyclone_sertype.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "tests/unit/common/bus/random_values.hpp"

namespace limbcast::bus::cyclone {
namespace {

using body::SegmentState;
using C = Codec<SegmentState>;

struct Unref {
  void operator()(ddsi_serdata* data) const { ddsi_serdata_unref(data); }
  void operator()(ddsi_sertype* type) const { ddsi_sertype_unref(type); }
};
using Data = std::unique_ptr<ddsi_serdata, Unref>;

class CycloneSertypeTest : public ::testing::Test {
 protected:
  Data FromSample(ddsi_serdata_kind kind) {
    return Data(ddsi_serdata_from_sample(type_.get(), kind, &wire_));
  }
  std::vector<char> BytesOf(const Data& data) {
    const auto payload = Payload(data.get());
    return {payload.begin(), payload.end()};
  }

  std::mt19937_64 rng_{20240517};
  const SegmentState value_ = testing::RandomValue<SegmentState>(rng_);
  C::Wire wire_ = [this] {
    C::Wire wire;
    EXPECT_TRUE(C::Encode(value_, wire));
    return wire;
  }();
  int malformed_ = 0;
  std::unique_ptr<ddsi_sertype, Unref> type_{
      MakeSertype(WireOpsOf<SegmentState>(), [this](const char*) { ++malformed_; })};
};

TEST_F(CycloneSertypeTest, ASampleIsItsCdr) {
  const Data data = FromSample(SDK_DATA);
  ASSERT_NE(data, nullptr);
  C::Wire read;
  ASSERT_TRUE(C::Deserialize(Payload(data.get()), read));
  EXPECT_TRUE(read == wire_);
  EXPECT_EQ(ddsi_serdata_size(data.get()) % 4, 0U);
  EXPECT_GE(ddsi_serdata_size(data.get()), Payload(data.get()).size());
  C::Wire taken;
  ASSERT_TRUE(ddsi_serdata_to_sample(data.get(), &taken, nullptr, nullptr));
  EXPECT_TRUE(taken == wire_);
}

TEST_F(CycloneSertypeTest, BytesOfTheNetworkMakeTheSameSample) {
  const Data sent = FromSample(SDK_DATA);
  const Data received(MakeSerdata(type_.get(), SDK_DATA, BytesOf(sent)));
  ASSERT_NE(received, nullptr);
  EXPECT_EQ(BytesOf(received), BytesOf(sent));
  EXPECT_TRUE(type_->serdata_ops->eqkey(sent.get(), received.get()));
  EXPECT_EQ(sent->hash, received->hash);
}

TEST_F(CycloneSertypeTest, KeysOfSampleKeyMessageAndKeyHashAgree) {
  const Data sample = FromSample(SDK_DATA);
  const Data key = FromSample(SDK_KEY);
  ddsi_keyhash hash{};
  ddsi_serdata_get_keyhash(sample.get(), &hash, false);
  const Data from_hash(type_->serdata_ops->from_keyhash(type_.get(), &hash));
  ASSERT_NE(from_hash, nullptr);
  for (const Data* other : {&key, &from_hash}) {
    EXPECT_TRUE(type_->serdata_ops->eqkey(sample.get(), other->get()));
    EXPECT_EQ(sample->hash, (*other)->hash);
    C::Wire wire;
    SegmentState decoded;
    ASSERT_TRUE(C::DeserializeKey(Payload(other->get()), wire));
    ASSERT_TRUE(C::DecodeKey(wire, decoded));
    EXPECT_EQ(C::Key(decoded), C::Key(value_));
  }
}

TEST_F(CycloneSertypeTest, AKeyMessageIsTooLongForFastDdsToTakeItForAKeyHash) {
  const Data key = FromSample(SDK_KEY);
  EXPECT_GT(ddsi_serdata_size(key.get()), 16U);
  std::vector<char> bytes(ddsi_serdata_size(key.get()));
  ddsi_serdata_to_ser(key.get(), 0, bytes.size(), bytes.data());
  const Data received(MakeSerdata(type_.get(), SDK_KEY, bytes));
  ASSERT_NE(received, nullptr);
  EXPECT_TRUE(type_->serdata_ops->eqkey(key.get(), received.get()));
}

TEST_F(CycloneSertypeTest, TheKeyHashIsBigEndianCdr) {
  wire_.body_id(0x01020304);
  wire_.segment(5);
  wire_.slot(1);
  const Data sample = FromSample(SDK_DATA);
  ddsi_keyhash hash{};
  ddsi_serdata_get_keyhash(sample.get(), &hash, false);
  const std::vector<std::uint8_t> expected = {1, 2, 3, 4, 5, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  EXPECT_EQ(std::vector<std::uint8_t>(std::begin(hash.value), std::end(hash.value)), expected);
}

TEST_F(CycloneSertypeTest, OtherInstancesHaveOtherKeys) {
  const Data one = FromSample(SDK_DATA);
  wire_.slot(static_cast<std::uint8_t>(wire_.slot() + 1));
  const Data other = FromSample(SDK_DATA);
  EXPECT_FALSE(type_->serdata_ops->eqkey(one.get(), other.get()));
}

TEST_F(CycloneSertypeTest, UntypedKeepsTheKeyAndDropsTheType) {
  const Data sample = FromSample(SDK_DATA);
  const Data untyped(ddsi_serdata_to_untyped(sample.get()));
  EXPECT_EQ(untyped->type, nullptr);
  EXPECT_EQ(untyped->kind, SDK_KEY);
  EXPECT_EQ(untyped->hash, sample->hash);
  EXPECT_TRUE(type_->serdata_ops->eqkey(untyped.get(), sample.get()));
}

TEST_F(CycloneSertypeTest, ABytesTooShortForTheKeyAreRefusedAndTold) {
  const std::vector<char> good = BytesOf(FromSample(SDK_DATA));
  const std::size_t key_end = 4 + 6;
  for (std::size_t size = 0; size < key_end; ++size) {
    const std::vector<char> cut(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_EQ(MakeSerdata(type_.get(), SDK_DATA, cut), nullptr) << size;
    EXPECT_EQ(MakeSerdata(type_.get(), SDK_KEY, cut), nullptr) << size;
  }
  EXPECT_EQ(malformed_, 2 * static_cast<int>(key_end));
}

TEST_F(CycloneSertypeTest, RandomBytesNeverCrash) {
  for (int trial = 0; trial < 5000; ++trial) {
    std::vector<char> bytes(rng_() % 64);
    for (char& byte : bytes) {
      byte = static_cast<char>(rng_());
    }
    if (bytes.size() > 1 && trial % 2 == 0) {
      bytes[0] = 0;
      bytes[1] = 1;
    }
    const auto kind = trial % 3 == 0 ? SDK_KEY : SDK_DATA;
    if (const Data data(MakeSerdata(type_.get(), kind, bytes)); data != nullptr) {
      C::Wire wire;
      EXPECT_FALSE(ddsi_serdata_to_sample(data.get(), &wire, nullptr, nullptr));
      const Data untyped(ddsi_serdata_to_untyped(data.get()));
      EXPECT_NE(untyped, nullptr);
    }
  }
}

TEST_F(CycloneSertypeTest, PartsAreCopiedOut) {
  const Data sample = FromSample(SDK_DATA);
  const std::vector<char> bytes = BytesOf(sample);
  std::vector<char> part(8);
  ddsi_serdata_to_ser(sample.get(), 4, part.size(), part.data());
  EXPECT_EQ(part, std::vector<char>(bytes.begin() + 4, bytes.begin() + 12));
  ddsrt_iovec_t whole;
  ddsi_serdata* referenced = ddsi_serdata_to_ser_ref(sample.get(), 0, bytes.size(), &whole);
  EXPECT_EQ(std::memcmp(whole.iov_base, bytes.data(), bytes.size()), 0);
  ddsi_serdata_to_ser_unref(referenced, &whole);
  const Data again(ddsi_serdata_from_ser_iov(type_.get(), SDK_DATA, 1, &whole, bytes.size()));
  EXPECT_EQ(BytesOf(again), bytes);
}

}  // namespace
}  // namespace limbcast::bus::cyclone
