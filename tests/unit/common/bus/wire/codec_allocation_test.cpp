#include <gtest/gtest.h>

#include <array>
#include <random>

#include "common/bus/wire/codec.hpp"
#include "common/bus/wire/wire_types.hpp"
#include "tests/support/allocation_counter.hpp"
#include "tests/unit/common/bus/random_values.hpp"

namespace limbcast::bus::testing {
namespace {

template <typename T>
std::size_t AllocationsOfARoundTripAfterTheFirst() {
  std::mt19937_64 rng(20240517);
  T value = RandomValue<T>(rng);
  if constexpr (requires { value.filter; }) {
    value.filter = "gauss_newton";  // names of filters are short
  }
  if constexpr (requires { value.states; }) {
    for (auto& state : value.states) {
      state.filter = "gauss_newton";
    }
  }
  T decoded;
  typename Codec<T>::Wire sent;
  typename Codec<T>::Wire received;
  std::array<char, 32768> bytes{};
  bool good = true;
  std::size_t before = 0;
  for (int round = 0; round < 10; ++round) {
    if (round == 1) {
      before = test_support::AllocationCount();
    }
    good = good && Codec<T>::Encode(value, sent);
    const std::size_t size = Codec<T>::Serialize(sent, bytes);
    good = good && size > 0 && Codec<T>::Deserialize(std::span(bytes).first(size), received);
    good = good && Codec<T>::Decode(received, decoded);
    good = good && Codec<T>::Key(decoded) == Codec<T>::Key(value);
  }
  const std::size_t allocations = test_support::AllocationCount() - before;
  EXPECT_TRUE(good);
  EXPECT_TRUE(Equal(value, decoded));
  return allocations;
}

TEST(CodecAllocationTest, TheHotPathAllocatesNothingOnceItsObjectsHaveGrown) {
  EXPECT_EQ(AllocationsOfARoundTripAfterTheFirst<sensing::MargSample>(), 0U);
  EXPECT_EQ(AllocationsOfARoundTripAfterTheFirst<sensing::MargFrame>(), 0U);
  EXPECT_EQ(AllocationsOfARoundTripAfterTheFirst<body::SegmentState>(), 0U);
  EXPECT_EQ(AllocationsOfARoundTripAfterTheFirst<body::SegmentFrame>(), 0U);
  EXPECT_EQ(AllocationsOfARoundTripAfterTheFirst<body::Skeleton>(), 0U);
}

TEST(CodecAllocationTest, TheCounterCounts) {
  const std::size_t before = test_support::AllocationCount();
  const std::vector<int> allocated(100);
  EXPECT_EQ(allocated.size(), 100U);
  EXPECT_GT(test_support::AllocationCount(), before);
}

}  // namespace
}  // namespace limbcast::bus::testing
