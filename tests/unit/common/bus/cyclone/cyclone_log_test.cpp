#include "common/bus/cyclone/cyclone_log.hpp"

#include <dds/ddsrt/log.h>
#include <gtest/gtest.h>

namespace limbcast::bus::cyclone {
namespace {

TEST(CycloneLogTest, KeepsTheLastWarningOnOneLineAndPrintsNothing) {
  QuietCycloneLog();
  ::testing::internal::CaptureStderr();
  dds_log(DDS_LC_WARNING, __FILE__, __LINE__, __func__, "first\n");
  dds_log(DDS_LC_ERROR, __FILE__, __LINE__, __func__, "port %d in use\n", 7400);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(LastCycloneError(), "port 7400 in use");
}

}  // namespace
}  // namespace limbcast::bus::cyclone
