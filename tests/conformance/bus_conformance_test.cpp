#include "tests/conformance/bus_conformance.hpp"
#include "tests/conformance/dds_conformance.hpp"

namespace limbcast::conformance {
namespace {

using bus::Vendor;

const Pair kInproc{"inproc", Vendor::kInproc, Vendor::kInproc, false};
const Pair kCyclone{"cyclone", Vendor::kCyclone, Vendor::kCyclone, false};
const Pair kFast{"fast", Vendor::kFast, Vendor::kFast, false};
const Pair kCycloneTwo{"cyclone_two_processes", Vendor::kCyclone, Vendor::kCyclone, true};
const Pair kFastTwo{"fast_two_processes", Vendor::kFast, Vendor::kFast, true};
const Pair kCycloneToFast{"cyclone_to_fast", Vendor::kCyclone, Vendor::kFast, true};
const Pair kFastToCyclone{"fast_to_cyclone", Vendor::kFast, Vendor::kCyclone, true};

std::string Name(const ::testing::TestParamInfo<Pair>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Pairs, BusConformance,
                         ::testing::Values(kInproc, kCyclone, kFast, kCycloneTwo, kFastTwo,
                                           kCycloneToFast, kFastToCyclone),
                         Name);

// Not for inproc: it has no network to be silent, garbled or mismatched on, and its handlers run on
// the writing thread, so one that hangs does hold the writer back.
INSTANTIATE_TEST_SUITE_P(Pairs, DdsConformance,
                         ::testing::Values(kCyclone, kFast, kCycloneTwo, kFastTwo, kCycloneToFast,
                                           kFastToCyclone),
                         Name);

INSTANTIATE_TEST_SUITE_P(Pairs, SlowReaderConformance,
                         ::testing::Values(kFast, kCycloneTwo, kFastTwo, kCycloneToFast,
                                           kFastToCyclone),
                         Name);

INSTANTIATE_TEST_SUITE_P(Pairs, LossyConformance, ::testing::Values(kCycloneTwo, kCycloneToFast),
                         Name);

INSTANTIATE_TEST_SUITE_P(Pairs, ProcessConformance,
                         ::testing::Values(kCycloneTwo, kFastTwo, kCycloneToFast, kFastToCyclone),
                         Name);

}  // namespace
}  // namespace limbcast::conformance
