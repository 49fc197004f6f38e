#include "tests/unit/common/bus/wire/codec_properties.hpp"

namespace limbcast::bus::testing {
namespace {

using HealthTopics = ::testing::Types<ServiceHealth>;
INSTANTIATE_TYPED_TEST_SUITE_P(Health, CodecTest, HealthTopics);

TEST(HealthCodecTest, BoundsInsideListsAreChecked) {
  ExpectOutOfBounds(ServiceHealth{.values = {{.name = std::string(49, 'v')}}},
                    "health.name has 49 characters, at most 48 are allowed");
  ExpectOutOfBounds(ServiceHealth{.values = std::vector<NamedValue>(97)},
                    "health.values has 97 elements, at most 96 are allowed");
  ExpectOutOfBounds(ServiceHealth{.latencies = std::vector<LatencyQuantiles>(17)},
                    "health.latencies has 17 elements, at most 16 are allowed");
}

}  // namespace
}  // namespace limbcast::bus::testing
