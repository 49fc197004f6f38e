#include "common/filters/position/backward_pass.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>
#include <vector>

#include "common/filters/position/lag_window.hpp"

namespace limbcast::filters {
namespace {

// A small linear case: position and velocity (they mix) and an acceleration bias that decays; the
// position is measured now and then. One axis, Z = 1.
constexpr int kN = 3;
constexpr int kM = 2;
constexpr int kEpochs = 40;
using Vector = Eigen::Matrix<double, kN, 1>;
using Matrix = Eigen::Matrix<double, kN, kN>;
using Record = BackwardRecord<kN, kM, 1>;

struct Forward {
  std::vector<Record> records;
  std::vector<Vector> x_before, x_after;
  std::vector<Matrix> P_before, P_after;
  std::vector<double> z;
  std::vector<bool> measured;
  Matrix F, Q, P0;
  Vector x0;
  double R = 0.04;
};

bool IsMeasured(int k) { return k < 12 || k > 24; }  // a gap in the middle

Forward RunForward() {
  std::mt19937 rng(7);
  std::normal_distribution<double> normal;
  Forward run;
  BlockTransition<kN, kM> transition;
  constexpr double kD = 0.1;
  transition.top << 1.0, kD, -0.5 * kD * kD, 0.0, 1.0, -kD;
  transition.decay << 0.98;
  run.F = transition.Dense();
  run.Q = Vector(1e-5, 1e-3, 1e-4).asDiagonal();
  run.P0 = Vector(1.0, 0.5, 0.2).asDiagonal();
  run.x0 = Vector(0.1, -0.2, 0.0);
  Vector x = run.x0;
  Matrix P = run.P0;
  for (int k = 0; k < kEpochs; ++k) {
    Record record;
    record.into = transition;
    record.chain_begins = k == 0;
    if (k > 0) {
      x = run.F * x;
      PropagateCovariance(transition, P);
      P += run.Q;
    }
    run.x_before.push_back(x);
    run.P_before.push_back(P);
    run.z.push_back(0.3 * k * kD + 0.2 * normal(rng));
    run.measured.push_back(IsMeasured(k));
    if (IsMeasured(k)) {
      record.measurement.H = Eigen::RowVector3d(1.0, 0.0, 0.0);
      record.measurement.nu[0] = run.z.back() - x[0];
      const Eigen::Matrix<double, 1, 1> R(run.R);
      const SoftGateConfig open{.downweight_above_nis = 1e9, .reject_above_nis = 1e12};
      SoftUpdate<kN, 1>(open, R, true, P, record.measurement);
      x += record.measurement.K * record.measurement.nu;
    }
    run.x_after.push_back(x);
    run.P_after.push_back(P);
    run.records.push_back(record);
  }
  return run;
}

struct Smoothed {
  std::vector<Vector> x{kEpochs};
  std::vector<Matrix> P{kEpochs};
};

// Design/position.md section 5 as it is written there, from epoch `last` back.
Smoothed Rts(const Forward& run, int last) {
  Smoothed s;
  const auto at = [](int k) { return static_cast<std::size_t>(k); };
  s.x[at(last)] = run.x_after[at(last)];
  s.P[at(last)] = run.P_after[at(last)];
  for (int k = last - 1; k >= 0; --k) {
    const Matrix S = run.P_after[at(k)] * run.F.transpose() * run.P_before[at(k + 1)].inverse();
    s.x[at(k)] = run.x_after[at(k)] + S * (s.x[at(k + 1)] - run.x_before[at(k + 1)]);
    s.P[at(k)] =
        run.P_after[at(k)] + S * (s.P[at(k + 1)] - run.P_before[at(k + 1)]) * S.transpose();
  }
  return s;
}

Smoothed BrysonFrazier(const Forward& run, int last) {
  Smoothed s;
  Vector lambda = Vector::Zero();
  Matrix Lambda = Matrix::Zero();
  for (int k = last; k >= 0; --k) {
    const auto i = static_cast<std::size_t>(k);
    s.x[i] = run.x_after[i] + run.P_after[i] * lambda;
    s.P[i] = run.P_after[i] - run.P_after[i] * Lambda * run.P_after[i];
    StepBack(run.records[i], lambda);
    StepBack(run.records[i], Lambda);
  }
  return s;
}

TEST(BackwardPassTest, IsTheRecursionOfRauchTungAndStriebel) {
  const Forward run = RunForward();
  const Smoothed rts = Rts(run, kEpochs - 1);
  const Smoothed bf = BrysonFrazier(run, kEpochs - 1);
  for (std::size_t k = 0; k < kEpochs; ++k) {
    EXPECT_LT((bf.x[k] - rts.x[k]).norm(), 1e-10) << k;
    EXPECT_LT((bf.P[k] - rts.P[k]).norm(), 1e-10) << k;
  }
}

TEST(BackwardPassTest, IsBatchLeastSquares) {
  const Forward run = RunForward();
  // Unknowns: all states; rows: prior, transitions, measurements, each by its weight.
  constexpr int kAll = kN * kEpochs;
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(kAll, kAll);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(kAll);
  const Matrix prior = run.P0.inverse();
  information.topLeftCorner<kN, kN>() += prior;
  right.head<kN>() += prior * run.x0;
  const Matrix Q_inverse = run.Q.inverse();
  for (int k = 0; k < kEpochs; ++k) {
    if (k > 0) {
      Eigen::Matrix<double, kN, 2 * kN> J;
      J << -run.F, Matrix::Identity();
      information.block<2 * kN, 2 * kN>(kN * (k - 1), kN * (k - 1)) +=
          J.transpose() * Q_inverse * J;
    }
    if (run.measured[static_cast<std::size_t>(k)]) {
      information(kN * k, kN * k) += 1.0 / run.R;
      right[kN * k] += run.z[static_cast<std::size_t>(k)] / run.R;
    }
  }
  const Eigen::MatrixXd cov = information.inverse();
  const Eigen::VectorXd x = cov * right;
  const Smoothed bf = BrysonFrazier(run, kEpochs - 1);
  for (int k = 0; k < kEpochs; ++k) {
    const auto i = static_cast<std::size_t>(k);
    EXPECT_LT((bf.x[i] - x.segment<kN>(kN * k)).norm(), 1e-9) << k;
    EXPECT_LT((bf.P[i] - cov.block<kN, kN>(kN * k, kN * k)).norm(), 1e-9) << k;
  }
}

TEST(BackwardPassTest, FixedLagIsTheRecursionTruncated) {
  const Forward run = RunForward();
  constexpr std::size_t kLag = 8;
  LagWindow<kN, kM, 1, kN> window(kLag + 1);
  for (int k = 0; k < kEpochs; ++k) {
    const auto i = static_cast<std::size_t>(k);
    window.Push(run.records[i], run.P_after[i]);
    if (window.size() <= kLag) {
      continue;
    }
    const Smoothed rts = Rts(run, k);
    const Vector x = run.x_after[i - kLag] + window.Correction(kLag);
    const Matrix P = window.Covariance<kN>(kLag, run.P_after[i - kLag]);
    EXPECT_LT((x - rts.x[i - kLag]).norm(), 1e-10) << k;
    EXPECT_LT((P - rts.P[i - kLag]).norm(), 1e-10) << k;
  }
}

TEST(BackwardPassTest, NothingGoesBackPastARestart) {
  Forward run = RunForward();
  run.records[20].chain_begins = true;
  const Smoothed bf = BrysonFrazier(run, kEpochs - 1);
  EXPECT_EQ((bf.x[19] - run.x_after[19]).norm(), 0.0);
  EXPECT_EQ((bf.P[19] - run.P_after[19]).norm(), 0.0);
  EXPECT_GT((bf.x[20] - run.x_after[20]).norm(), 0.0);
}

}  // namespace
}  // namespace limbcast::filters
