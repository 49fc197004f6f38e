#include "common/filters/filter_state_codec.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace limbcast::filters {
namespace {

struct State {
  double value = 0.0;
  double other = 0.0;
};

std::vector<std::byte> Saved(const State& state) {
  std::vector<std::byte> bytes(SavedStateSize_bytes<State>());
  WriteState("tqt", 3, state, bytes);
  return bytes;
}

TEST(FilterStateCodecTest, ReadsBackWhatWasWritten) {
  const auto bytes = Saved({.value = 1.25, .other = -7.0});
  State state;
  ASSERT_TRUE(ReadState("tqt", 3, bytes, state).ok());
  EXPECT_EQ(state.value, 1.25);
  EXPECT_EQ(state.other, -7.0);
}

TEST(FilterStateCodecTest, RefusesOtherFiltersVersionsSizesAndDamageAndChangesNothing) {
  auto bytes = Saved({.value = 1.25, .other = -7.0});
  State state{.value = 9.0, .other = 9.0};
  EXPECT_EQ(ReadState("bmf", 3, bytes, state).error().code, ErrorCode::kCorruptData);
  EXPECT_FALSE(ReadState("tqt", 4, bytes, state).ok());
  EXPECT_FALSE(ReadState("tqt", 3, std::span(bytes).first(bytes.size() - 1), state).ok());
  EXPECT_FALSE(ReadState("tqt", 3, std::span(bytes).first(0), state).ok());
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    auto damaged = bytes;
    damaged[at] ^= std::byte{0x10};
    EXPECT_FALSE(ReadState("tqt", 3, damaged, state).ok()) << "byte " << at;
  }
  EXPECT_EQ(state.value, 9.0);
}

}  // namespace
}  // namespace limbcast::filters
