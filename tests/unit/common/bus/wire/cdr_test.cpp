#include "common/bus/cdr.hpp"

#include <gtest/gtest.h>

#include "tests/unit/common/bus/random_values.hpp"

namespace limbcast::bus::testing {
namespace {

template <typename T>
void ExpectRoundTrip(std::mt19937_64& rng) {
  const T value = RandomValue<T>(rng);
  std::vector<std::byte> bytes;
  T decoded;
  ASSERT_TRUE(EncodeCdr(value, bytes));
  ASSERT_TRUE(DecodeCdr<T>(bytes, decoded));
  EXPECT_TRUE(Equal(value, decoded)) << WireTypeName<T>();
  bytes.pop_back();
  const Status cut = DecodeCdr<T>(bytes, decoded);
  ASSERT_FALSE(cut);
  EXPECT_EQ(cut.error().code, ErrorCode::kCorruptData);
  EXPECT_EQ(cut.error().message,
            std::to_string(bytes.size()) + " bytes are no " + std::string(WireTypeName<T>()));
}

template <typename... Ts>
void ExpectRoundTrips(std::mt19937_64& rng, std::tuple<Ts...>* /*topics*/) {
  (ExpectRoundTrip<Ts>(rng), ...);
}

TEST(CdrTest, EveryTopicSurvivesItsBytesAndACutIsRefused) {
  std::mt19937_64 rng(20240517);
  ExpectRoundTrips(rng, static_cast<AllTopics*>(nullptr));
}

TEST(CdrTest, BytesAreLittleEndianXcdr1WithItsHeader) {
  std::vector<std::byte> bytes;
  ASSERT_TRUE(EncodeCdr(sensing::MargSample{.sensor_uid = {1}}, bytes));
  ASSERT_EQ(bytes.size(), 4U + 72U);
  EXPECT_EQ(bytes[0], std::byte{0});
  EXPECT_EQ(bytes[1], std::byte{1});
  EXPECT_EQ(bytes[4], std::byte{1});
}

TEST(CdrTest, ABoundExceededIsNamed) {
  std::vector<std::byte> bytes;
  const Status encoded = EncodeCdr(ServiceHealth{.role = std::string(33, 'r')}, bytes);
  ASSERT_FALSE(encoded);
  EXPECT_EQ(encoded.error().message, "health.role has 33 characters, at most 32 are allowed");
}

TEST(CdrTest, NamesAreThoseOfTheIdl) {
  EXPECT_EQ(WireTypeName<body::Skeleton>(), "limbcast::wire::Skeleton");
}

}  // namespace
}  // namespace limbcast::bus::testing
