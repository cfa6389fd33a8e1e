#include "problems/linear_elimination.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <random>

#include "tests/roundoff.h"

namespace batten {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

LinearElimination Made(int num_variables, const std::vector<LinearConstraint>& constraints) {
  LinearElimination elimination;
  std::string error;
  EXPECT_TRUE(LinearElimination::Make(num_variables, constraints, &elimination, &error)) << error;
  return elimination;
}

std::string Refusal(int num_variables, const std::vector<LinearConstraint>& constraints) {
  LinearElimination elimination;
  std::string error;
  EXPECT_FALSE(LinearElimination::Make(num_variables, constraints, &elimination, &error));
  EXPECT_TRUE(elimination.trivial()) << "a refusal must leave the elimination as it was";
  return error;
}

struct DenseConstraints {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd values;
};

std::vector<LinearConstraint> AsList(const DenseConstraints& dense) {
  std::vector<LinearConstraint> list;
  for (Eigen::Index i = 0; i < dense.matrix.rows(); ++i) {
    LinearConstraint constraint{"row " + std::to_string(i), {}, dense.values[i]};
    for (int v = 0; v < dense.matrix.cols(); ++v) {
      if (dense.matrix(i, v) != 0.0) constraint.coefficients.emplace_back(v, dense.matrix(i, v));
    }
    list.push_back(constraint);
  }
  return list;
}

/// Random constraints with `rank` independent rows; the others are combinations of them.
DenseConstraints RandomConstraints(int num_rows, int rank, int num_variables, double density,
                                   std::mt19937* random) {
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const auto fill = [&](int rows, int cols, double filled) {
    Eigen::MatrixXd matrix(rows, cols);
    for (double& entry : matrix.reshaped()) {
      entry = number(*random);
      if (0.5 * (number(*random) + 1.0) > filled) entry = 0.0;
    }
    return matrix;
  };
  Eigen::MatrixXd independent = fill(rank, num_variables, density);
  // One place of each row is its own, so that rows are not zero and not dependent.
  for (int r = 0; r < rank; ++r) independent(r, (7 * r) % num_variables) += 3.0;
  Eigen::MatrixXd combinations(num_rows, rank);
  combinations << Eigen::MatrixXd::Identity(rank, rank), fill(num_rows - rank, rank, 1.0);
  DenseConstraints dense;
  dense.matrix = combinations * independent;
  dense.values = combinations * fill(rank, 1, 1.0);
  return dense;
}

/// The orthogonal projector onto the null space of `matrix`, by a complete orthogonal
/// decomposition.
Eigen::MatrixXd NullSpaceProjector(const Eigen::MatrixXd& matrix) {
  const Eigen::Index n = matrix.cols();
  return Eigen::MatrixXd::Identity(n, n) -
         matrix.completeOrthogonalDecomposition().pseudoInverse() * matrix;
}

struct RandomCase {
  int num_rows, rank, num_variables;
  double density;
};

class RandomConstraintsTest : public ::testing::TestWithParam<RandomCase> {};

TEST_P(RandomConstraintsTest, SpanTheSameSpaceAsDenseNullSpaceAlgebra) {
  const RandomCase& size = GetParam();
  std::mt19937 random(20240611u + static_cast<unsigned>(size.num_variables));
  const DenseConstraints dense =
      RandomConstraints(size.num_rows, size.rank, size.num_variables, size.density, &random);
  const LinearElimination elimination = Made(size.num_variables, AsList(dense));
  ASSERT_EQ(elimination.num_free(size.num_variables), size.num_variables - size.rank);

  // About one rounding per term and row, enlarged by the condition of Z, which is below 1e3 here.
  const double tolerance = 1e3 * size.num_variables * kEpsilon;
  const Eigen::MatrixXd z = elimination.z();
  const Eigen::MatrixXd projector = z * (z.transpose() * z).ldlt().solve(z.transpose());
  EXPECT_LT((projector - NullSpaceProjector(dense.matrix)).norm(), tolerance);

  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(z.cols());
  EXPECT_LT((dense.matrix * elimination.Expand(zero) - dense.values).norm(), tolerance);
}

INSTANTIATE_TEST_SUITE_P(Sizes, RandomConstraintsTest,
                         ::testing::Values(RandomCase{1, 1, 2, 1.0}, RandomCase{4, 4, 9, 1.0},
                                           RandomCase{9, 6, 20, 0.3}, RandomCase{12, 12, 13, 0.5},
                                           RandomCase{20, 20, 20, 0.2},
                                           RandomCase{60, 45, 80, 0.05},
                                           RandomCase{70, 60, 100, 1.0}));

TEST(LinearElimination, WithoutConstraintsIsTheIdentity) {
  const LinearElimination elimination = Made(3, {});
  const Eigen::Vector3d x(0.3, -1.7, 2.9);
  EXPECT_TRUE(elimination.trivial());
  EXPECT_EQ(elimination.num_free(3), 3);
  EXPECT_EQ(elimination.Expand(x), x);
  EXPECT_EQ(elimination.ExpandDirection(x), x);
  EXPECT_EQ(elimination.Restrict(x), x);
  EXPECT_EQ(elimination.FreeVariables(x), x);
  Eigen::SparseMatrix<double, Eigen::RowMajor> z;
  Points offset;
  ASSERT_TRUE(elimination.ForPoints(0, 4, 2, &z, &offset));
  EXPECT_EQ(Eigen::MatrixXd(z), Eigen::MatrixXd::Identity(4, 4));
  EXPECT_EQ(offset, Points::Zero(4, 2));
}

TEST(LinearElimination, GivesUpTheVariableWithTheLargestCoefficient) {
  const LinearElimination elimination = Made(4, {{"plane", {{0, 1.0}, {2, -4.0}, {3, 2.0}}, 8.0}});
  EXPECT_THAT(elimination.free(), ElementsAre(0, 1, 3));
  // x2 = (8 - x0 - 2 x3) / -4, exact in binary.
  EXPECT_EQ(elimination.Expand(Eigen::Vector3d(1.0, 5.0, 0.5)),
            Eigen::Vector4d(1.0, 5.0, -1.5, 0.5));
  EXPECT_EQ(elimination.ExpandDirection(Eigen::Vector3d(1.0, 5.0, 0.5)),
            Eigen::Vector4d(1.0, 5.0, 0.5, 0.5));
  EXPECT_EQ(elimination.Restrict(Eigen::Vector4d(1.0, 2.0, 4.0, 8.0)),
            Eigen::Vector3d(2.0, 2.0, 10.0));
}

TEST(LinearElimination, TakesFreeVariablesOfPointsThatViolateTheConstraints) {
  const LinearElimination elimination = Made(3, {{"sum", {{0, 1.0}, {1, 1.0}, {2, 2.0}}, 4.0}});
  const Eigen::VectorXd y = elimination.FreeVariables(Eigen::Vector3d(10.0, 20.0, 30.0));
  EXPECT_EQ(y, Eigen::Vector2d(10.0, 20.0));
  EXPECT_EQ(elimination.Expand(y), Eigen::Vector3d(10.0, 20.0, -13.0));
}

TEST(LinearElimination, AllowsEveryVariableToBeFixed) {
  const LinearElimination elimination = Made(2, {{"a", {{0, 2.0}}, 3.0}, {"b", {{1, 4.0}}, 1.0}});
  EXPECT_FALSE(elimination.trivial());
  EXPECT_EQ(elimination.num_free(2), 0);
  EXPECT_EQ(elimination.Expand(Eigen::VectorXd(0)), Eigen::Vector2d(1.5, 0.25));
}

TEST(LinearElimination, AddsCoefficientsOfARepeatedVariable) {
  const LinearElimination elimination = Made(2, {{"twice", {{0, 1.0}, {0, 1.0}, {1, 1.0}}, 4.0}});
  EXPECT_EQ(elimination.Expand(Eigen::VectorXd::Constant(1, 2.0)), Eigen::Vector2d(1.0, 2.0));
}

TEST(LinearElimination, AllowsRepeatedConstraintsWhoseNumbersRound) {
  // 0.1 + 0.2 is not 0.3 in binary, and a third of 3 thirds is not 1.
  const LinearElimination elimination = Made(3, {{"first", {{0, 1.0}}, 0.1},
                                                 {"second", {{1, 1.0}}, 0.2},
                                                 {"sum", {{0, 1.0}, {1, 1.0}}, 0.3},
                                                 {"third", {{0, 1.0 / 3.0}, {2, 1.0 / 7.0}}, 0.7},
                                                 {"again", {{0, 1.0}, {2, 3.0 / 7.0}}, 2.1},
                                                 {"first", {{0, 1.0}}, 0.1}});
  EXPECT_EQ(elimination.num_free(3), 0);
}

TEST(LinearElimination, KeepsCoefficientsThatAreSmallButMeant) {
  const LinearElimination elimination =
      Made(2, {{"tilted", {{0, 1.0}, {1, 1e-20}}, 1.0}, {"wall", {{0, 1.0}}, 1.0}});
  EXPECT_EQ(elimination.num_free(2), 0);
  EXPECT_EQ(elimination.Expand(Eigen::VectorXd(0)), Eigen::Vector2d(1.0, 0.0));
}

TEST(LinearElimination, NamesTheConstraintsThatContradictEachOther) {
  const std::string error = Refusal(4, {{"start at 1", {{0, 1.0}}, 1.0},
                                        {"unrelated", {{3, 1.0}}, 5.0},
                                        {"closed", {{0, 1.0}, {1, -1.0}}, 0.0},
                                        {"also unrelated", {{2, 1.0}, {3, 1.0}}, 0.0},
                                        {"end at 2", {{1, 1.0}}, 2.0}});
  EXPECT_EQ(error,
            "linear constraints \"start at 1\", \"closed\" and \"end at 2\" contradict each other");
}

TEST(LinearElimination, RefusesContradictionsFarBelowTheSizeOfTheNumbers) {
  // 1e-9 of the value: a million times the roundings.
  const std::string error =
      Refusal(2, {{"a", {{0, 1.0}, {1, 3.0}}, 1e6}, {"b", {{0, 2.0}, {1, 6.0}}, 2e6 + 1e-3}});
  EXPECT_THAT(error, HasSubstr("\"a\" and \"b\""));
}

TEST(LinearElimination, ShortensTheListOfALongContradiction) {
  std::vector<LinearConstraint> chain;
  for (int i = 0; i < 100; ++i) chain.push_back({"", {{i, 1.0}, {i + 1, -1.0}}, 0.0});
  chain.push_back({"gap", {{0, 1.0}, {100, -1.0}}, 1.0});
  const std::string error = Refusal(101, chain);
  EXPECT_THAT(error, HasSubstr("number 1, number 2,"));
  EXPECT_THAT(error, HasSubstr("and 94 more contradict each other"));
}

TEST(LinearElimination, RefusesAConstraintWithoutVariables) {
  EXPECT_THAT(Refusal(2, {{"empty", {}, 0.0}}), HasSubstr("\"empty\" has no variable"));
  EXPECT_THAT(Refusal(2, {{"zero", {{1, 0.0}}, 1.0}}), HasSubstr("\"zero\" has no variable"));
  EXPECT_THAT(Refusal(2, {{"cancels", {{1, 2.0}, {1, -2.0}}, 1.0}}),
              HasSubstr("\"cancels\" has no variable"));
}

TEST(LinearElimination, RefusesNumbersThatAreNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THAT(Refusal(2, {{"a", {{1, nan}}, 1.0}}), HasSubstr("\"a\" has a number that is not"));
  EXPECT_THAT(Refusal(2, {{"b", {{1, 1.0}}, infinity}}), HasSubstr("\"b\" has a number"));
}

TEST(LinearElimination, FollowsChainsInEitherDirection) {
  const int n = 20000;
  for (const bool ascending : {true, false}) {
    std::vector<LinearConstraint> chain;
    for (int k = 0; k + 1 < n; ++k) {
      const int i = ascending ? k : n - 2 - k;
      chain.push_back({"step", {{i + 1, 1.0}, {i, -1.0}}, 1.0});
    }
    const LinearElimination elimination = Made(n, chain);
    ASSERT_EQ(elimination.num_free(n), 1);
    EXPECT_EQ(elimination.z().nonZeros(), n);
    const Eigen::VectorXd x = elimination.Expand(Eigen::VectorXd::Constant(1, 0.5));
    for (int i = 0; i + 1 < n; ++i) ASSERT_EQ(x[i + 1], x[i] + 1.0) << i;
  }
}

TEST(LinearElimination, ClosesARingOnceAndKeepsItSparse) {
  std::vector<LinearConstraint> ring;
  for (int i = 0; i < 1000; ++i) ring.push_back({"equal", {{i, 0.1}, {(i + 1) % 1000, -0.1}}, 0.0});
  const LinearElimination elimination = Made(1001, ring);
  EXPECT_EQ(elimination.num_free(1001), 2);
  EXPECT_EQ(elimination.z().nonZeros(), 1001);
}

/// The same constraints on every coordinate of points that begin at x[begin].
std::vector<LinearConstraint> ForEveryCoordinate(
    const std::vector<std::pair<int, double>>& coefficients, int begin, int dimension) {
  std::vector<LinearConstraint> constraints;
  for (int c = 0; c < dimension; ++c) {
    LinearConstraint constraint{"coordinate " + std::to_string(c), {}, 0.5 * c - 1.25};
    for (const auto& [point, coefficient] : coefficients) {
      constraint.coefficients.emplace_back(begin + point * dimension + c, coefficient);
    }
    constraints.push_back(constraint);
  }
  return constraints;
}

TEST(ForPoints, ReducesAlikeCoordinatesToOneMatrix) {
  const int begin = 2, num_points = 5, dimension = 3;
  std::vector<LinearConstraint> constraints =
      ForEveryCoordinate({{0, 1.0}, {1, -2.5}, {3, 0.7}}, begin, dimension);
  for (const auto& constraint :
       ForEveryCoordinate({{0, 0.3}, {1, 1.1}, {4, -1.3}}, begin, dimension)) {
    constraints.push_back(constraint);
  }
  const int n = begin + num_points * dimension + 1;  // one variable more on the right
  const LinearElimination elimination = Made(n, constraints);
  Eigen::SparseMatrix<double, Eigen::RowMajor> z;
  Points offset;
  ASSERT_TRUE(elimination.ForPoints(begin, num_points, dimension, &z, &offset));
  ASSERT_EQ(z.rows(), num_points);
  ASSERT_EQ(z.cols(), 3);

  std::mt19937 random(20240612);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  Eigen::VectorXd y(elimination.num_free(n));
  for (double& entry : y) entry = number(random);
  const Eigen::VectorXd x = elimination.Expand(y);
  const Points points = Eigen::Map<const Points>(x.data() + begin, num_points, dimension);
  const Points reduced = Eigen::Map<const Points>(y.data() + begin, z.cols(), dimension);
  const double tolerance = 8 * kEpsilon;  // sums of three terms of size 1, in another order
  EXPECT_LT((offset + z * reduced - points).cwiseAbs().maxCoeff(), tolerance);
}

TEST(ForPoints, RefusesCoordinatesThatAreTreatedDifferently) {
  Eigen::SparseMatrix<double, Eigen::RowMajor> z;
  Points offset;
  const auto refused = [&](const std::vector<LinearConstraint>& constraints) {
    return !Made(9, constraints).ForPoints(0, 4, 2, &z, &offset);
  };
  EXPECT_TRUE(refused({{"x only", {{0, 1.0}}, 0.0}}));
  EXPECT_TRUE(refused({{"y only", {{1, 1.0}}, 0.0}}));
  EXPECT_TRUE(refused({{"mixed", {{0, 1.0}, {1, 1.0}}, 0.0}}));
  EXPECT_TRUE(refused({{"x", {{0, 1.0}, {2, 0.5}}, 0.0}, {"y", {{1, 1.0}, {3, 0.25}}, 0.0}}));
  EXPECT_TRUE(refused({{"x", {{0, 1.0}, {2, 0.5}}, 0.0}, {"y", {{1, 1.0}, {5, 0.5}}, 0.0}}));
  EXPECT_TRUE(refused({{"outside", {{8, 1.0}}, 0.0}}));
  EXPECT_TRUE(refused({{"coupled", {{0, 1.0}, {8, 0.5}}, 0.0}}));
  EXPECT_FALSE(refused({{"x", {{0, 1.0}, {2, 0.5}}, 0.0}, {"y", {{1, 1.0}, {3, 0.5}}, 7.0}}));
}

}  // namespace
}  // namespace batten
