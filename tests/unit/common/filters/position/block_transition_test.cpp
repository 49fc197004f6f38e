#include "common/filters/position/block_transition.hpp"

#include <gtest/gtest.h>

#include <random>

namespace limbcast::filters {
namespace {

constexpr int kN = 7;
constexpr int kM = 3;
using Matrix = Eigen::Matrix<double, kN, kN>;

class BlockTransitionTest : public ::testing::Test {
 protected:
  BlockTransitionTest() {
    std::mt19937 rng(3);
    std::normal_distribution<double> normal;
    const auto random = [&]() { return normal(rng); };
    F.top = F.top.NullaryExpr(random);
    F.decay << 1.0, 0.9, 1.0, 0.5;
    const Matrix root = Matrix::NullaryExpr(random);
    const Matrix square = root * root.transpose();
    symmetric = 0.5 * (square + square.transpose());
  }
  BlockTransition<kN, kM> F;
  Matrix symmetric;
};

TEST_F(BlockTransitionTest, PropagatesLikeItsDenseForm) {
  Matrix P = symmetric;
  PropagateCovariance(F, P);
  EXPECT_LT((P - F.Dense() * symmetric * F.Dense().transpose()).norm(), 1e-12);
  EXPECT_EQ((P - P.transpose()).norm(), 0.0);
}

TEST_F(BlockTransitionTest, GoesBackLikeItsTransposed) {
  Eigen::Matrix<double, kN, 1> lambda;
  lambda << 1, -2, 3, -4, 5, -6, 7;
  const Eigen::Matrix<double, kN, 1> expected = F.Dense().transpose() * lambda;
  PropagateBack(F, lambda);
  EXPECT_LT((lambda - expected).norm(), 1e-12);

  Matrix Lambda = symmetric;
  PropagateBack(F, Lambda);
  EXPECT_LT((Lambda - F.Dense().transpose() * symmetric * F.Dense()).norm(), 1e-12);
}

}  // namespace
}  // namespace limbcast::filters
