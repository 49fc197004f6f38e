#include "common/bus/fastdds/fast_log.hpp"

#include <gtest/gtest.h>

#include <fastdds/dds/log/Log.hpp>

namespace limbcast::bus::fastdds {
namespace {

TEST(FastLogTest, ErrorsAreKeptOnOneLineAndNotPrinted) {
  QuietFastLog();
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  EPROSIMA_LOG_ERROR(LIMBCAST, "no port\nleft");
  EXPECT_EQ(LastFastError(), "no port left");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace limbcast::bus::fastdds
