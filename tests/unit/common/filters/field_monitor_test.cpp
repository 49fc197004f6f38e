#include "common/filters/field_monitor.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>

namespace limbcast::filters {
namespace {

using Eigen::Vector3d;

const Vector3d kReference(0.0, 0.4, -0.9165151389911680);

void Feed(FieldMonitor& monitor, double seconds, const Vector3d& field) {
  for (int i = 0; i < static_cast<int>(seconds * 100.0); ++i) {
    monitor.Update(field.squaredNorm(), field.z(), kReference.z(), 0.01);
  }
}

TEST(FieldMonitorTest, TheReferenceIsClean) {
  FieldMonitor monitor;
  Feed(monitor, 1.0, kReference);
  EXPECT_EQ(monitor.magnetic_state(), MagneticState::kClean);
}

TEST(FieldMonitorTest, AWrongHeadingAloneIsNoDisturbance) {
  FieldMonitor monitor;
  Feed(monitor, 1.0, Vector3d(0.4, 0.0, kReference.z()));
  EXPECT_EQ(monitor.magnetic_state(), MagneticState::kClean);
}

TEST(FieldMonitorTest, ALongerOrSteeperFieldIsDisturbedAndRecovers) {
  for (const Vector3d& field : {Vector3d(1.3 * kReference), Vector3d(0.0, 0.7, -0.71414)}) {
    FieldMonitor monitor;
    Feed(monitor, 1.5, field);
    EXPECT_EQ(monitor.magnetic_state(), MagneticState::kDisturbed);
    Feed(monitor, 1.5, kReference);
    EXPECT_EQ(monitor.magnetic_state(), MagneticState::kClean);
  }
}

TEST(FieldMonitorTest, AnAbsurdReadingIsForgottenInTwoSeconds) {
  FieldMonitor monitor;
  monitor.Update(1e24, -1e12, kReference.z(), 0.01);
  Feed(monitor, 2.0, kReference);
  EXPECT_EQ(monitor.magnetic_state(), MagneticState::kClean);
}

}  // namespace
}  // namespace limbcast::filters
