#include "common/filters/position/soft_update.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace limbcast::filters {
namespace {

using Matrix2 = Eigen::Matrix2d;
using Record = MeasurementRecord<2, 1>;
const Eigen::Matrix<double, 1, 1> kR(1.0);

Record Measure(double nu) {
  Record record;
  record.H << 1.0, 0.0;
  record.nu[0] = nu;
  return record;
}

TEST(SoftUpdateTest, WithinTheGateItIsAKalmanUpdate) {
  Matrix2 P;
  P << 4.0, 1.0, 1.0, 2.0;
  Record record = Measure(2.0);
  const UpdateReport report = SoftUpdate<2, 1>({}, kR, true, P, record);
  EXPECT_EQ(report.outcome, GateOutcome::kFused);
  EXPECT_DOUBLE_EQ(report.nis, 4.0 / 5.0);
  EXPECT_DOUBLE_EQ(record.K[0], 0.8);
  EXPECT_DOUBLE_EQ(record.K[1], 0.2);
  EXPECT_DOUBLE_EQ(P(0, 0), 4.0 - 0.8 * 4.0);
  EXPECT_DOUBLE_EQ(P(1, 1), 2.0 - 0.2 * 1.0);
}

TEST(SoftUpdateTest, FarOutsideItPullsAsMuchAsOneOnTheGate) {
  const auto pull = [](double nu) {
    Matrix2 P = 4.0 * Matrix2::Identity();
    Record record = Measure(nu);
    const UpdateReport report = SoftUpdate<2, 1>({}, kR, true, P, record);
    EXPECT_TRUE(record.fused);
    EXPECT_EQ(report.outcome, report.nis > 16.0 ? GateOutcome::kDownweighted : GateOutcome::kFused);
    return record.K[0] * nu;
  };
  const double on_the_gate = pull(std::sqrt(16.0 * 5.0) * (1.0 - 1e-12));
  // NIS = 16·s²: the gain falls with s², so the pull falls with s.
  EXPECT_NEAR(pull(2.0 * std::sqrt(16.0 * 5.0)), on_the_gate / 2.0, 1e-9);
}

TEST(SoftUpdateTest, RejectsBeyondTheLimitUnlessItMayNot) {
  Matrix2 P = 4.0 * Matrix2::Identity();
  const Matrix2 before = P;
  Record record = Measure(1000.0);
  EXPECT_EQ((SoftUpdate<2, 1>({}, kR, true, P, record).outcome), GateOutcome::kRejected);
  EXPECT_EQ(P, before);
  EXPECT_FALSE(record.fused);
  EXPECT_EQ((SoftUpdate<2, 1>({}, kR, false, P, record).outcome), GateOutcome::kDownweighted);
  EXPECT_TRUE(record.fused);
}

TEST(SoftUpdateTest, NothingFiniteNothingDone) {
  Matrix2 P = Matrix2::Identity();
  Record record = Measure(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ((SoftUpdate<2, 1>({}, kR, false, P, record).outcome), GateOutcome::kRejected);
  EXPECT_EQ(P, Matrix2::Identity());
}

}  // namespace
}  // namespace limbcast::filters
