#include "services/posture/motion_log.hpp"

#include <gtest/gtest.h>

#include "common/math/rotation.hpp"

namespace limbcast::posture {
namespace {

using body::Segment;
using namespace std::chrono_literals;

constexpr SegmentSet kBoth = BitOf(Segment::kPelvis) | BitOf(Segment::kHead);

void Fill(MotionLog& log, Segment segment, Duration period, double seconds) {
  for (Duration t{}; t < DurationFromSeconds(seconds); t += period) {
    log.Add(segment, Time{100s} + t, math::ExpSO3({0.0, 0.0, 0.1 * ToSeconds(t)}),
            Eigen::Vector3f(static_cast<float>(ToSeconds(t)), 0.0F, 0.0F));
  }
}

TEST(MotionLogTest, WhateverTheRatesTheRecordIsEvenAndOfTheSameInstants) {
  MotionLog log;
  Fill(log, Segment::kPelvis, 2500us, 10.0);  // 400 Hz
  Fill(log, Segment::kHead, 16667us, 10.0);   // 60 Hz
  const auto record = log.Extract(kBoth, *log.newest(), 5.0);
  ASSERT_EQ(record.segments.size(), 2U);
  EXPECT_EQ(record.size(), 250U);
  EXPECT_EQ(record.segments[0].segment, Segment::kPelvis);
  for (std::size_t i = 0; i < record.size(); ++i) {
    EXPECT_LT(math::AngleBetween_rad(record.segments[0].q_earth_sensor[i],
                                     record.segments[1].q_earth_sensor[i]),
              0.1 * 0.02)
        << "not more than a bin apart";
  }
}

TEST(MotionLogTest, ShortGapsAreBridgedAndLongOnesLeaveTheSegmentOut) {
  MotionLog log;
  for (int i = 0; i < 200; ++i) {
    const Time at = Time{100s} + i * 20ms;
    const Eigen::Quaterniond q = math::ExpSO3({0.0, 0.0, 0.01 * i});
    if (i < 150 || i > 154) {
      log.Add(Segment::kPelvis, at, q, Eigen::Vector3f::Zero());
    }
    if (i < 150 || i > 170) {
      log.Add(Segment::kHead, at, q, Eigen::Vector3f::Zero());
    }
  }
  const auto record = log.Extract(kBoth, *log.newest(), 3.0);
  ASSERT_EQ(record.segments.size(), 1U);
  EXPECT_EQ(record.segments[0].segment, Segment::kPelvis);
  EXPECT_EQ(record.size(), 150U);
  EXPECT_LT(math::AngleBetween_rad(record.segments[0].q_earth_sensor[102],
                                   math::ExpSO3({0.0, 0.0, 1.52})),
            1e-4);
}

TEST(MotionLogTest, WhatWasNotHeardAllTheTimeIsLeftOut) {
  MotionLog log;
  EXPECT_FALSE(log.newest().has_value());
  Fill(log, Segment::kPelvis, 10ms, 4.0);
  EXPECT_TRUE(log.Extract(kBoth, *log.newest(), 5.0).segments.empty()) << "only 4 s so far";
  EXPECT_EQ(log.Extract(kBoth, *log.newest(), 3.0).segments.size(), 1U);
  log.Clear();
  EXPECT_FALSE(log.newest().has_value());
}

}  // namespace
}  // namespace limbcast::posture
